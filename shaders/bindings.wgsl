// Group 0, the only one: two uniforms and the eight storage buffers that WebGPU guarantees.
@group(0) @binding(0) var<uniform> frame: Frame;
@group(0) @binding(1) var<uniform> dispatch: Dispatch;
// Bindings 2 to 4 are in memory/words/buffers.wgsl or memory/pairs/buffers.wgsl.
@group(0) @binding(5) var<storage, read> materials: array<Material>;
@group(0) @binding(6) var<storage, read> lights: array<Light>;
@group(0) @binding(7) var<storage, read> texels: array<u32>;
@group(0) @binding(8) var<storage, read_write> film: array<FilmPixel>;
@group(0) @binding(9) var<storage, read_write> status: Status;

// What a scene does not use is compiled out: `FeatureSet` in src/flatten/features.rs sets these.
override HAS_SPHERE: bool = true;
override HAS_CUBE: bool = true;
override HAS_CYLINDER: bool = true;
override HAS_CONE: bool = true;
override HAS_TORUS: bool = true;
override HAS_PLANE: bool = true;
override HAS_MESH: bool = true;
// Any bounded shape but meshes.
override HAS_ANALYTIC: bool = true;
// Any bounded shape, mists included, beside one mesh: rays look for instances first.
override HAS_INSTANCES: bool = true;
// So many meshes that neighbouring rays part among them.
override HAS_MANY_MESHES: bool = true;
override HAS_REFLECTION: bool = true;
override HAS_REFRACTION: bool = true;
override HAS_GLOSSY: bool = true;
override HAS_AREA_LIGHT: bool = true;
override HAS_LENS: bool = true;
override HAS_TEXTURE: bool = true;
override HAS_BUMP: bool = true;
override HAS_MIST: bool = true;
override HAS_SHADOWLESS: bool = true;
override HAS_MANY_LIGHTS: bool = true;
override HAS_BACKGROUND_IMAGE: bool = true;
