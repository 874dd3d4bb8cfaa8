-- Runs before every scene: closes what reaches beyond it, and brings back what scenes for older Luas expect.
-- `host` holds the functions of src/script/modules.rs.
local host = ...

local error, getmetatable, pcall, rawget, select, tostring, type, xpcall =
      error, getmetatable, pcall, rawget, select, tostring, type, xpcall
local load, setmetatable = load, setmetatable
local concat, pack = table.concat, table.pack
local refuse = host.refuse

-- Errors. Whatever can catch one asks the host, which raises again what must end the script.

local function settle(done, ...)
  if done then return true, ... end
  return false, host.caught((...))
end

function _G.pcall(...)
  return settle(pcall(...))
end

function _G.xpcall(body, handler, ...)
  return settle(xpcall(body, function(problem) return handler(host.caught(problem)) end, ...))
end

local create, wrap, resume, close = coroutine.create, coroutine.wrap, coroutine.resume, coroutine.close

function coroutine.create(body)
  host.charge()
  return create(body)
end

function coroutine.wrap(body)
  host.charge()
  return wrap(body)
end

function coroutine.resume(...)
  return settle(resume(...))
end

function coroutine.close(thread)
  return settle(close(thread))
end

local function loaded_text(chunk, problem)
  if chunk then return chunk end
  return nil, host.caught(problem)
end

-- Code as text only, under a name that messages can show.
function _G.load(chunk, name, mode, ...)
  if type(name) ~= 'string' then
    name = '=(load)'
  elseif not name:find('^[@=]') then
    name = '=' .. name
  end
  return loaded_text(load(chunk, name, 't', ...))
end

-- Finalisers run where no limit holds.
function _G.setmetatable(value, meta)
  if type(meta) == 'table' and rawget(meta, '__gc') ~= nil then
    refuse('setmetatable', 'scenes cannot have finalisers (__gc)')
  end
  return setmetatable(value, meta)
end

function _G.getmetatable(value)
  if type(value) == 'userdata' then
    return host.is_node(value) and gr or nil
  end
  return getmetatable(value)
end

-- Files.

function _G.dofile(name)
  return host.load_file(name)()
end

function _G.loadfile(name)
  local done, chunk = pcall(host.load_file, name)
  if done then return chunk end
  return nil, host.caught(chunk)
end

local function readobj(name)
  local both = host.read_obj(name)
  return both[1], both[2]
end

package = { loaded = { _G = _G }, path = '?.lua;?/init.lua', cpath = '', preload = {}, config = '/\n;\n?\n!\n-\n' }
for _, name in ipairs { 'coroutine', 'table', 'string', 'utf8', 'math' } do
  package.loaded[name] = _G[name]
end
local loaded, preload = package.loaded, package.preload

function require(name)
  if loaded[name] ~= nil then return loaded[name] end
  local chunk = preload[name] or host.find_module(name)
  local result
  if chunk then
    result = chunk(name)
  else
    -- The only module of our own: what the skeleton from before 2015 came with.
    _G.readobj, result = readobj, readobj
  end
  if result ~= nil then
    loaded[name] = result
  elseif loaded[name] == nil then
    loaded[name] = true
  end
  return loaded[name]
end

local open, lines, iotype = io.open, io.lines, io.type

local function write(...)
  for position = 1, select('#', ...) do
    host.print(tostring((select(position, ...))))
  end
end

local function stream()
  local self = {}
  function self:write(...) write(...) return self end
  function self:flush() return self end
  function self:setvbuf() return true end
  return self
end

io = { type = iotype, stdout = stream(), stderr = stream(), flush = function() end }

function io.open(name, mode)
  mode = mode or 'r'
  if mode ~= 'r' and mode ~= 'rb' then
    refuse('io.open', "scenes read files and write none (mode '" .. tostring(mode) .. "')")
  end
  local found = host.find_readable(name)
  if not found.path then return nil, found.problem, 2 end
  return open(found.path, mode)
end

function io.lines(name, ...)
  if name == nil then refuse('io.lines', 'expected the name of a file') end
  local found = host.find_readable(name)
  if not found.path then refuse('io.lines', found.problem) end
  return lines(found.path, ...)
end

function io.close(file)
  return file:close()
end

function io.write(...)
  write(...)
  return io.stdout
end

function print(...)
  local words = pack(...)
  for position = 1, words.n do
    words[position] = tostring(words[position])
  end
  host.print(concat(words, '\t') .. '\n')
end

-- What scenes do without.

os = { clock = os.clock, date = os.date, difftime = os.difftime, time = os.time, getenv = function() return nil end }

debug = {}

function debug.traceback(message)
  return message
end

function debug.getinfo()
  local place = host.source_at()
  local source, line = place:match('^(.*):(%d+)$')
  return { source = '@' .. (source or ''), short_src = source or '', currentline = tonumber(line) or -1, what = 'Lua' }
end

local function forbid(library, names, why)
  for name in names:gmatch('%S+') do
    local full = library .. '.' .. name
    _G[library][name] = function() refuse(full, why) end
  end
end

forbid('os', 'execute exit remove rename tmpname setlocale', 'not available to scenes')
forbid('io', 'popen tmpfile output input read', 'not available to scenes')
forbid('package', 'loadlib searchpath', 'not available to scenes')
forbid('string', 'dump', 'not available to scenes')
forbid('debug', 'sethook getregistry setmetatable getmetatable getupvalue setupvalue getlocal setlocal upvaluejoin debug',
  'not available to scenes')

-- Random numbers that are the same in every run, whole bounds or not.

local random, randomseed, floor, mathtype = math.random, math.randomseed, math.floor, math.type

local function whole(bound)
  if mathtype(bound) == 'float' then return floor(bound) end
  return bound
end

function math.random(low, high)
  if low == nil then return random() end
  if high == nil then return random(whole(low)) end
  return random(whole(low), whole(high))
end

function math.randomseed(...)
  if select('#', ...) == 0 then return randomseed(host.seed) end
  return randomseed(...)
end

randomseed(host.seed)

-- Lua 5.0 to 5.3.

unpack = table.unpack
loadstring = _G.load
string.gfind = string.gmatch
math.mod = math.fmod
math.pow = function(base, exponent) return base ^ exponent end
math.log10 = function(x) return math.log(x, 10) end
math.ldexp = function(x, exponent) return x * 2.0 ^ exponent end
math.cosh = function(x) return (math.exp(x) + math.exp(-x)) / 2 end
math.sinh = function(x) return (math.exp(x) - math.exp(-x)) / 2 end
math.tanh = function(x) return 1 - 2 / (math.exp(2 * x) + 1) end

function table.getn(list)
  return #list
end

function table.maxn(list)
  local last = 0
  for key in pairs(list) do
    if type(key) == 'number' and key > last then last = key end
  end
  return last
end

function table.foreach(list, visit)
  for key, value in pairs(list) do
    local result = visit(key, value)
    if result ~= nil then return result end
  end
end

function table.foreachi(list, visit)
  for position = 1, #list do
    local result = visit(position, list[position])
    if result ~= nil then return result end
  end
end
