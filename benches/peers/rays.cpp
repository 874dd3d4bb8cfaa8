// The paths of benches/rays on Embree 3: `walk` there and here is the same, number for number.
//
//   g++ -O3 -march=native -o embree_rays benches/peers/rays.cpp -lembree3 -lpthread
//   ./embree_rays MESH THREADS      MESH: nine little-endian floats a triangle; prints rays and seconds
#include <algorithm>
#include <atomic>
#include <chrono>
#include <cmath>
#include <cstdint>
#include <cstdio>
#include <cstdlib>
#include <embree3/rtcore.h>
#include <fstream>
#include <iterator>
#include <thread>
#include <vector>

namespace {

constexpr int edge = 512, samples = 4, bounces = 3;

struct Vec3 {
    float x, y, z;
};
Vec3 operator+(Vec3 a, Vec3 b) { return {a.x + b.x, a.y + b.y, a.z + b.z}; }
Vec3 operator*(float s, Vec3 a) { return {s * a.x, s * a.y, s * a.z}; }
float dot(Vec3 a, Vec3 b) { return a.x * b.x + a.y * b.y + a.z * b.z; }
Vec3 normalize(Vec3 a) { return 1 / std::sqrt(dot(a, a)) * a; }

uint32_t pcg(uint32_t value) {
    uint32_t state = value * 747796405u + 2891336453u;
    uint32_t word = ((state >> ((state >> 28) + 4)) ^ state) * 277803737u;
    return (word >> 22) ^ word;
}

float uniform(uint32_t &state) {
    state = pcg(state);
    return (state >> 8) / 16777216.0f;
}

// The paths of one pixel; returns their rays.
long walk(RTCScene scene, RTCIntersectContext &context, int x, int y) {
    uint32_t state = pcg(x + y * edge);
    long rays = 0;
    for (int sample = 0; sample < samples; sample++) {
        float px = (x + uniform(state)) / edge * 2 - 1, py = 1 - (y + uniform(state)) / edge * 2;
        Vec3 origin = {0, 1.2f, 3.2f}, direction = normalize({0.8f * px, 0.8f * py - 0.35f, -1});
        for (int bounce = 0; bounce <= bounces; bounce++) {
            rays++;
            RTCRayHit query = {};
            query.ray = {origin.x, origin.y, origin.z, 0, direction.x, direction.y, direction.z, 0, 1e30f, ~0u, 0, 0};
            query.hit.geomID = query.hit.instID[0] = RTC_INVALID_GEOMETRY_ID;
            rtcIntersect1(scene, &context, &query);
            if (query.hit.geomID == RTC_INVALID_GEOMETRY_ID)
                break;
            Vec3 normal = normalize({query.hit.Ng_x, query.hit.Ng_y, query.hit.Ng_z});
            if (dot(normal, direction) > 0)
                normal = -1 * normal;
            origin = origin + query.ray.tfar * direction + 1e-3f * normal;
            float phi = 6.2831853f * uniform(state), z = 2 * uniform(state) - 1;
            float sine = std::sqrt(std::fmax(1 - z * z, 0.0f));
            direction = normalize(normal + 0.999f * Vec3{sine * std::cos(phi), sine * std::sin(phi), z});
        }
    }
    return rays;
}

} // namespace

int main(int count, char **arguments) {
    std::ifstream file(count == 3 ? arguments[1] : "", std::ios::binary);
    if (!file) {
        std::fprintf(stderr, "usage: embree_rays MESH THREADS\n");
        return 1;
    }
    std::vector<char> bytes{std::istreambuf_iterator<char>(file), {}};
    const size_t corners = bytes.size() / 12;
    RTCDevice device = rtcNewDevice(nullptr);
    RTCScene scene = rtcNewScene(device);
    RTCGeometry mesh = rtcNewGeometry(device, RTC_GEOMETRY_TYPE_TRIANGLE);
    auto *positions = static_cast<char *>(
        rtcSetNewGeometryBuffer(mesh, RTC_BUFFER_TYPE_VERTEX, 0, RTC_FORMAT_FLOAT3, 12, corners));
    auto *indices = static_cast<uint32_t *>(
        rtcSetNewGeometryBuffer(mesh, RTC_BUFFER_TYPE_INDEX, 0, RTC_FORMAT_UINT3, 12, corners / 3));
    std::copy_n(bytes.begin(), 12 * corners, positions);
    for (size_t i = 0; i < corners; i++)
        indices[i] = i;
    rtcCommitGeometry(mesh);
    rtcAttachGeometry(scene, mesh);
    rtcCommitScene(scene);

    const auto trace = [&] {
        std::atomic<int> row{0};
        std::atomic<long> rays{0};
        std::vector<std::thread> pool;
        for (int i = 0; i < std::atoi(arguments[2]); i++)
            pool.emplace_back([&] {
                RTCIntersectContext context;
                rtcInitIntersectContext(&context);
                long own = 0;
                for (int y; (y = row++) < edge;)
                    for (int x = 0; x < edge; x++)
                        own += walk(scene, context, x, y);
                rays += own;
            });
        for (auto &thread : pool)
            thread.join();
        return rays.load();
    };
    trace(); // warm-up
    const auto start = std::chrono::steady_clock::now();
    const long rays = trace();
    std::printf("%ld %.6f\n", rays, std::chrono::duration<double>(std::chrono::steady_clock::now() - start).count());
}
