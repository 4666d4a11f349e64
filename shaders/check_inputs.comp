#version 460
#extension GL_GOOGLE_include_directive : require
#extension GL_EXT_scalar_block_layout : require
#include "light_field.glsl"
#include "gbuffer_read.glsl"
#include "shared/input_check.h"

// Counts pixels of a host's G-buffer that lie where probes see a surface, for each of some guesses at what its matrix and depth mean; then, by one of
// them, what its normals and colours mean. Counts start as 0. Dispatch: a group for every 64 pixels of the lattice.
layout(local_size_x = kCheckGroup) in;
layout(scalar, set = 1, binding = kCheckGuessesBinding) readonly buffer SconceGuesses { InputGuess guess[]; };
layout(scalar, set = 1, binding = kCheckCountsBinding) buffer SconceCounts { InputCounts counts; };
layout(scalar, push_constant) uniform Push { InputCheckPush push; };

const float kOnSurface = 0.02; // of the distance to the probe, that a point may be off what it sees
const float kAlike = 0.87;     // cosine between normals: 30 degrees
const float kCells = 24.0;     // along the scene's diagonal
const float kFits = 0.2;       // relative, of albedos

vec3 eyeOf(InputGuess g)
{
    vec4 eye = g.worldFromClip * vec4(0.0, 0.0, 1.0, 0.0); // every ray's: whatever the depth's scale
    return eye.xyz / eye.w;
}

vec3 along(InputGuess g, vec2 ndc)
{
    vec4 ahead = g.worldFromClip * vec4(ndc, 1.0, 1.0);
    return normalize(ahead.xyz / ahead.w - eyeOf(g));
}

/// @return  whether the pixel shows a surface
bool placeOf(InputGuess g, vec2 ndc, float depth, out vec3 world)
{
    float d = g.depth == kDepthForward ? 1.0 - depth : depth;
    if (g.depth >= kDepthAlongAxis)
    {
        vec3 direction = along(g, ndc);
        world = eyeOf(g) + direction * (g.depth == kDepthAlongAxis ? d / max(dot(direction, along(g, vec2(0.0))), 1e-3) : d);
    }
    else
    {
        vec4 at = g.worldFromClip * vec4(ndc, d, 1.0);
        world = at.xyz / at.w;
    }
    return d > 0.0;
}

/// A probe that sees a surface at a point, its place relative to the probe, and the surface's normal on the probe's side.
struct Known
{
    uint probe; // kNoProbe: none does
    vec3 from;
    vec3 normal;
};

Known knownAt(vec3 world, vec3 eye)
{
    Known known = Known(kNoProbe, vec3(0.0), vec3(0.0));
    vec3 point = sconceFieldPoint(world);
    if (!all(lessThan(abs(point), vec3(4.0 * field.diagonal)))) return known; // false for NaN
    int reads = 0;
    uvec4 ranked = rankedProbesAt(point + 0.5 * field.voxel * normalize(eye - world), reads);
    float nearest = kOnSurface;
    for (int k = 0; k < kRanked; ++k)
    {
        vec3 from = point - vec3(probeHeader(ranked[k]).centre);
        vec3 plane = planeSeen(ranked[k], from);
        float off = abs(dot(plane, from) - 1.0);
        if (!(off < nearest)) continue;
        nearest = off;
        known = Known(ranked[k], from, -normalize(plane));
    }
    return known;
}

vec3 normalBy(uint meaning, InputGuess g, vec3 read)
{
    if (meaning == kNormalOfView || meaning == kNormalOfViewAway)
    {
        vec3 right = normalize(along(g, vec2(1.0, 0.0)) - along(g, vec2(-1.0, 0.0)));
        vec3 up = normalize(along(g, vec2(0.0, -1.0)) - along(g, vec2(0.0, 1.0)));
        vec3 back = -along(g, vec2(0.0));
        return read.x * right + read.y * up + (meaning == kNormalOfView ? read.z : -read.z) * back;
    }
    vec3 world = meaning == kNormalPacked ? 2.0 * read - 1.0 : meaning == kNormalInward ? -read : read;
    return mat3(g.turn) * (frame.fieldFromNormals * world);
}

float decoded(float c) { return c <= 0.04045 ? c / 12.92 : pow((c + 0.055) / 1.055, 2.4); }
float encoded(float c) { return c <= 0.0031308 ? 12.92 * c : 1.055 * pow(c, 1.0 / 2.4) - 0.055; }

/// What a surface scatters of the light that arrives, as the probe saw it; negative: it can't be told.
float albedoSeen(Known known, vec3 normal)
{
    if (!holdsRadiance() || field.surfaceSize == 0u || onOctahedron()) return -1.0;
    SurfaceTaps taps = surfaceTaps(known.probe, known.from, normal);
    if (!(taps.weight > 0.5)) return -1.0;
    TraceResult seen;
    seen.probe = known.probe;
    seen.face = dominantFace(known.from);
    vec3 uvw = faceCoordinates(seen.face, known.from);
    seen.pixel = clamp((uvw.xy / uvw.z + 1.0) * (0.5 * float(field.faceSize)), vec2(0.0), vec2(float(field.faceSize) - 0.5));
    seen.word = texelWord(mapWords(seen.probe, seen.face), uint(seen.pixel.x), uint(seen.pixel.y));
    float light = luminance(taps.light) / taps.weight;
    return light > 1e-4 ? luminance(surfelRadiance(seen)) / light : -1.0;
}

void countColors(Known known, vec4 base)
{
    float own = luminance(base.rgb);
    if (base.a > 0.1 || own < 0.02 || own > 0.9) return;
    float albedo = albedoSeen(known, known.normal);
    if (!(albedo > 0.01)) return;
    atomicAdd(counts.lit, 1u);
    vec3 by[3] = {base.rgb, vec3(decoded(base.r), decoded(base.g), decoded(base.b)), vec3(encoded(base.r), encoded(base.g), encoded(base.b))};
    for (uint i = 0u; i < kColorMeanings; ++i)
        if (abs(luminance(by[i]) / albedo - 1.0) < kFits) atomicAdd(counts.tint[i], 1u);
}

bool inUnit(float x) { return x >= -1e-3 && x <= 1.001; }

void main()
{
    ivec2 size = textureSize(gDepth, 0);
    uint across = (uint(size.x) + push.every - 1u) / push.every, i = gl_GlobalInvocationID.x;
    ivec2 at = ivec2(push.every * uvec2(i % across, i / across) + push.every / 2u);
    if (i == 0u) counts.size = uvec2(size);
    if (any(greaterThanEqual(at, size))) return;
    float depth = texelFetch(gDepth, at, 0).r;
    vec4 normal = texelFetch(gNormalRoughness, at, 0), base = texelFetch(gBaseColorMetallic, at, 0);
    vec2 ndc = (vec2(at) + 0.5) / vec2(size) * 2.0 - 1.0;
    bool broken = !(depth + dot(abs(normal), vec4(1.0)) + dot(abs(base), vec4(1.0)) < 1e6);
    if (push.chosen == kMostGuesses)
    {
        atomicAdd(counts.pixels, 1u);
        if (broken) atomicAdd(counts.broken, 1u);
        else if (depth == 0.0) atomicAdd(counts.empty, 1u);
        if (broken) return;
        for (uint g = 0u; g < push.guesses; ++g)
        {
            vec3 world;
            if (!placeOf(guess[g], ndc, depth, world)) continue;
            atomicAdd(counts.shown[g], 1u);
            Known known = knownAt(world, eyeOf(guess[g]));
            if (known.probe == kNoProbe) continue;
            atomicAdd(counts.met[g], 1u);
            uvec3 cell = uvec3(ivec3(floor(sconceFieldPoint(world) * (kCells / field.diagonal))));
            atomicOr(counts.cells[g], 1u << ((cell.x * 73u + cell.y * 179u + cell.z * 283u) % 31u));
            if (dot(known.normal, normalBy(kNormalWorld, guess[g], normal.xyz)) > kAlike) atomicAdd(counts.facing[g], 1u);
        }
        return;
    }
    InputGuess g = guess[push.chosen];
    vec3 world;
    if (broken || !placeOf(g, ndc, depth, world)) return;
    if (abs(length(normal.xyz) - 1.0) > 0.05) atomicAdd(counts.uneven, 1u);
    if (!inUnit(min(base.r, min(base.g, base.b))) || !inUnit(max(base.r, max(base.g, base.b)))) atomicAdd(counts.colors, 1u);
    if (!inUnit(base.a)) atomicAdd(counts.metals, 1u);
    if (!inUnit(roughnessOf(normal.w))) atomicAdd(counts.roughnesses, 1u);
    Known known = knownAt(world, eyeOf(g));
    if (known.probe == kNoProbe) return;
    atomicAdd(counts.known, 1u);
    for (uint meaning = 0u; meaning < kNormalMeanings; ++meaning)
    {
        vec3 by = normalBy(meaning, g, normal.xyz);
        if (dot(known.normal, by) > kAlike * max(length(by), 1e-6)) atomicAdd(counts.agree[meaning], 1u);
    }
    countColors(known, base);
}
