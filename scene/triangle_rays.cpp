#include "scene/triangle_rays.h"

#include <algorithm>
#include <bit>
#include <cassert>

#include <embree3/rtcore.h>
#include <fmt/format.h>

#include "base/parallel.h"
#include "base/random.h"
#include "scene/closest_point.h"

namespace sconce
{
namespace
{

/// Range of the alpha a material can have: factor times the texels of its base colour image.
void alphaRange(const Scene& scene, const Material& material, float& low, float& high)
{
    low = high = material.baseColor.a;
    const int index = material.baseColorTexture.image;
    if (index < 0) return;
    const Image& image = scene.images[size_t(index)];
    if (image.rgba.empty()) return;
    uint8_t least = 255, most = 0;
    for (size_t texel = 3; texel < image.rgba.size(); texel += 4)
    {
        least = std::min(least, image.rgba[texel]);
        most = std::max(most, image.rgba[texel]);
    }
    low *= float(least) / 255.0f;
    high *= float(most) / 255.0f;
}

} // namespace

std::vector<Presence> trianglePresence(const Scene& scene)
{
    std::vector<Presence> ofMaterial(scene.materials.size(), Presence::solid);
    for (size_t index = 0; index < scene.materials.size(); ++index)
    {
        const Material& material = scene.materials[index];
        if (material.alphaCutoff <= 0.0f && !material.blended) continue;
        float low, high;
        alphaRange(scene, material, low, high);
        if (material.blended ? high <= 0.0f : high < material.alphaCutoff)
            ofMaterial[index] = Presence::absent;
        else if (low < (material.blended ? 1.0f : material.alphaCutoff))
            ofMaterial[index] = Presence::masked;
    }
    std::vector<Presence> presence(scene.triangles.size(), Presence::solid);
    for (size_t triangle = 0; triangle < presence.size(); ++triangle) presence[triangle] = ofMaterial[scene.triangleMaterial[triangle]];
    return presence;
}

// Solid and masked triangles are geometries of their own, so that Embree asks back about masked ones only.
struct TriangleRays::State
{
    const Scene* scene = nullptr;
    RTCDevice device = nullptr;
    RTCScene embree = nullptr;
    std::vector<Presence> presence;
    std::vector<uint32_t> triangleOf[2]; // [0] solid, [1] masked: Embree's primitive -> Scene::triangles

    ~State()
    {
        // Embree's device goes last: the scene was made with it.
        if (embree) rtcReleaseScene(embree);
        if (device) rtcReleaseDevice(device);
    }

    uint32_t triangle(uint32_t geometry, uint32_t primitive) const { return triangleOf[geometry][primitive]; }

    bool attach(uint32_t kind);
};

namespace
{

/// A ray's lot on a triangle, [0,1): by its bits, so that a ray asked again answers alike, and layers behind each other draw their own.
float lotOf(RTCRayN* ray, unsigned int count, unsigned int lane, uint32_t triangle)
{
    uint64_t seed = triangle;
    for (const float part : {RTCRayN_org_x(ray, count, lane), RTCRayN_org_y(ray, count, lane), RTCRayN_org_z(ray, count, lane),
                             RTCRayN_dir_x(ray, count, lane), RTCRayN_dir_y(ray, count, lane), RTCRayN_dir_z(ray, count, lane)})
        seed = Random(seed, std::bit_cast<uint32_t>(part)).bits();
    return Random(seed, 0).uniform();
}

/// Embree asks here about every hit on a masked triangle: what alpha takes away is not there.
template <class State> void alphaFilter(const RTCFilterFunctionNArguments* args)
{
    const State& state = *static_cast<const State*>(args->geometryUserPtr);
    const Scene& scene = *state.scene;
    for (unsigned int lane = 0; lane < args->N; ++lane)
    {
        if (args->valid[lane] == 0) continue;
        const uint32_t triangle = state.triangle(1, RTCHitN_primID(args->hit, args->N, lane));
        const uvec3 corners = scene.triangles[triangle];
        const float u = RTCHitN_u(args->hit, args->N, lane);
        const float v = RTCHitN_v(args->hit, args->N, lane);
        const vec2 uv = (1.0f - u - v) * scene.uvs[corners.x] + u * scene.uvs[corners.y] + v * scene.uvs[corners.z];
        const uint32_t material = scene.triangleMaterial[triangle];
        const float there = coverage(scene, material, uv);
        if (there <= 0.0f || (there < 1.0f && there <= lotOf(args->ray, args->N, lane, triangle))) args->valid[lane] = 0;
    }
}

RTCRay embreeRay(vec3 origin, vec3 direction, float tFar)
{
    RTCRay ray{};
    ray.org_x = origin.x, ray.org_y = origin.y, ray.org_z = origin.z;
    ray.dir_x = direction.x, ray.dir_y = direction.y, ray.dir_z = direction.z;
    ray.tfar = tFar, ray.mask = ~0u;
    return ray;
}

} // namespace

bool TriangleRays::State::attach(uint32_t kind)
{
    if (triangleOf[kind].empty()) return true; // geometry ids stay fixed: 0 solid, 1 masked
    RTCGeometry geometry = rtcNewGeometry(device, RTC_GEOMETRY_TYPE_TRIANGLE);
    auto* vertices = static_cast<float*>(
        rtcSetNewGeometryBuffer(geometry, RTC_BUFFER_TYPE_VERTEX, 0, RTC_FORMAT_FLOAT3, 3 * sizeof(float), scene->positions.size()));
    auto* indices = static_cast<uint32_t*>(
        rtcSetNewGeometryBuffer(geometry, RTC_BUFFER_TYPE_INDEX, 0, RTC_FORMAT_UINT3, 3 * sizeof(uint32_t), triangleOf[kind].size()));
    if (vertices && indices)
    {
        for (const vec3& position : scene->positions)
            for (int axis = 0; axis < 3; ++axis) *vertices++ = position[axis];
        for (uint32_t triangle : triangleOf[kind])
            for (int corner = 0; corner < 3; ++corner) *indices++ = scene->triangles[triangle][corner];
        if (kind == 1)
        {
            rtcSetGeometryUserData(geometry, this);
            rtcSetGeometryIntersectFilterFunction(geometry, alphaFilter<State>);
            rtcSetGeometryOccludedFilterFunction(geometry, alphaFilter<State>);
        }
        rtcCommitGeometry(geometry);
        rtcAttachGeometryByID(embree, geometry, kind);
    }
    rtcReleaseGeometry(geometry);
    return vertices && indices;
}

TriangleRays::TriangleRays(std::unique_ptr<State> owned) : state(std::move(owned)) {}
TriangleRays::TriangleRays(TriangleRays&&) noexcept = default;
TriangleRays& TriangleRays::operator=(TriangleRays&&) noexcept = default;
TriangleRays::~TriangleRays() = default;

Result<TriangleRays> TriangleRays::build(const Scene& scene)
{
    auto state = std::make_unique<State>();
    state->scene = &scene;
    state->presence = trianglePresence(scene);
    for (uint32_t triangle = 0; triangle < scene.triangles.size(); ++triangle)
        if (state->presence[triangle] != Presence::absent)
            state->triangleOf[state->presence[triangle] == Presence::masked].push_back(triangle);
    // No wider than AVX2: Embree's kernels differ in a few rays (by SSE's, a probe of the small box stands elsewhere), and processors with
    // wider ones shouldn't place and bake otherwise for that.
    state->device = rtcNewDevice("max_isa=avx2");
    if (!state->device)
        return Error{ErrorCode::deviceFailure,
                     fmt::format("Embree could not be started (error {}); check that the processor has SSE2 and memory is free.",
                                 int(rtcGetDeviceError(nullptr)))};
    state->embree = rtcNewScene(state->device);
    // Without it 16 to 18 % of rays aimed at shared edges slip through; with it less than 1 %.
    rtcSetSceneFlags(state->embree, RTC_SCENE_FLAG_ROBUST);
    const auto outOfMemory = [&](const std::string& what)
    {
        return Error{ErrorCode::outOfMemory, fmt::format("Embree {} the {} triangles of scene '{}'; free memory or split the scene.", what,
                                                         scene.triangles.size(), scene.name)};
    };
    if (!state->attach(0) || !state->attach(1)) return outOfMemory("ran out of memory for");
    rtcCommitScene(state->embree);
    if (const RTCError code = rtcGetDeviceError(state->device); code != RTC_ERROR_NONE)
        return outOfMemory(fmt::format("failed (code {}) on", int(code)));
    return TriangleRays(std::move(state));
}

std::optional<TriangleRays::Hit> TriangleRays::closest(vec3 origin, vec3 direction, float tFar) const
{
    RTCIntersectContext context;
    rtcInitIntersectContext(&context);
    RTCRayHit query{};
    query.ray = embreeRay(origin, direction, tFar);
    query.hit.geomID = RTC_INVALID_GEOMETRY_ID;
    rtcIntersect1(state->embree, &context, &query);
    if (query.hit.geomID == RTC_INVALID_GEOMETRY_ID) return std::nullopt;
    return Hit{query.ray.tfar, state->triangle(query.hit.geomID, query.hit.primID), {query.hit.u, query.hit.v}};
}

bool TriangleRays::occluded(vec3 origin, vec3 direction, float tFar) const
{
    RTCIntersectContext context;
    rtcInitIntersectContext(&context);
    RTCRay ray = embreeRay(origin, direction, tFar);
    rtcOccluded1(state->embree, &context, &ray);
    return ray.tfar < 0.0f; // Embree writes -infinity where something is hit
}

void TriangleRays::unoccluded(vec3 from, std::span<const vec3> to, std::span<uint8_t> seen) const
{
    RTCIntersectContext context;
    rtcInitIntersectContext(&context);
    context.flags = RTC_INTERSECT_CONTEXT_FLAG_COHERENT;
    RTCRay8 rays{};
    alignas(32) int valid[8];
    size_t target[8];
    for (size_t next = 0; next < to.size();)
    {
        int lanes = 0;
        for (; next < to.size() && lanes < 8; ++next)
        {
            if (!seen[next]) continue;
            const vec3 direction = to[next] - from;
            rays.org_x[lanes] = from.x, rays.org_y[lanes] = from.y, rays.org_z[lanes] = from.z;
            rays.dir_x[lanes] = direction.x, rays.dir_y[lanes] = direction.y, rays.dir_z[lanes] = direction.z;
            rays.tnear[lanes] = 0.0f, rays.tfar[lanes] = 1.0f, rays.mask[lanes] = ~0u;
            target[lanes++] = next;
        }
        // All that was left had been ruled out before.
        if (lanes == 0) break;
        for (int lane = 0; lane < 8; ++lane) valid[lane] = lane < lanes ? -1 : 0;
        rtcOccluded8(valid, state->embree, &context, &rays);
        for (int lane = 0; lane < lanes; ++lane) seen[target[lane]] = rays.tfar[lane] >= 0.0f;
    }
}

void TriangleRays::distances(std::span<const vec3> origins, std::span<const vec3> directions, int width, std::span<float> t) const
{
    assert(origins.size() == directions.size() && origins.size() == t.size() && (width == 1 || width == 8));
    constexpr size_t kBatch = 1024;
    parallelFor((t.size() + kBatch - 1) / kBatch,
                [&](size_t batch)
                {
                    RTCIntersectContext context;
                    rtcInitIntersectContext(&context);
                    const size_t end = std::min(t.size(), (batch + 1) * kBatch);
                    for (size_t first = batch * kBatch; first < end; first += size_t(width))
                    {
                        if (width == 1)
                        {
                            RTCRayHit one{};
                            one.ray = embreeRay(origins[first], directions[first], std::numeric_limits<float>::infinity());
                            one.hit.geomID = RTC_INVALID_GEOMETRY_ID;
                            rtcIntersect1(state->embree, &context, &one);
                            t[first] = one.ray.tfar;
                            continue;
                        }
                        RTCRayHit8 eight{};
                        alignas(32) int valid[8];
                        for (size_t lane = 0; lane < 8; ++lane)
                        {
                            valid[lane] = first + lane < end ? -1 : 0;
                            // Lanes past the end are not valid, but must not be read from beyond the arrays.
                            const size_t i = std::min(first + lane, end - 1);
                            eight.ray.org_x[lane] = origins[i].x, eight.ray.org_y[lane] = origins[i].y,
                            eight.ray.org_z[lane] = origins[i].z;
                            eight.ray.dir_x[lane] = directions[i].x, eight.ray.dir_y[lane] = directions[i].y,
                            eight.ray.dir_z[lane] = directions[i].z;
                            eight.ray.tfar[lane] = std::numeric_limits<float>::infinity();
                            eight.ray.mask[lane] = ~0u;
                            eight.hit.geomID[lane] = RTC_INVALID_GEOMETRY_ID;
                        }
                        rtcIntersect8(valid, state->embree, &context, &eight);
                        for (size_t lane = 0; first + lane < std::min(end, first + 8); ++lane) t[first + lane] = eight.ray.tfar[lane];
                    }
                });
}

float TriangleRays::nearest(vec3 point, float farthest) const
{
    RTCPointQueryContext context;
    rtcInitPointQueryContext(&context);
    RTCPointQuery query{};
    query.x = point.x, query.y = point.y, query.z = point.z;
    query.radius = farthest;
    struct Search
    {
        const State* state;
        vec3 point;
    } search{state.get(), point};
    const auto shrink = [](RTCPointQueryFunctionArguments* args) -> bool
    {
        const Search& asked = *static_cast<const Search*>(args->userPtr);
        const Scene& scene = *asked.state->scene;
        const uvec3 corners = scene.triangles[asked.state->triangle(args->geomID, args->primID)];
        const vec3 nearest =
            closestPointOnTriangle(asked.point, scene.positions[corners.x], scene.positions[corners.y], scene.positions[corners.z]);
        const float distance = glm::distance(nearest, asked.point);
        if (!(distance < args->query->radius)) return false;
        args->query->radius = distance;
        return true;
    };
    rtcPointQuery(state->embree, &query, &context, shrink, &search);
    return query.radius;
}

const Scene& TriangleRays::scene() const
{
    return *state->scene;
}
const std::vector<Presence>& TriangleRays::presence() const
{
    return state->presence;
}

} // namespace sconce
