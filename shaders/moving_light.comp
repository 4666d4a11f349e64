#version 460
#extension GL_GOOGLE_include_directive : require
#include "light_field.glsl"
#include "gbuffer_read.glsl"
#include "tiles.glsl"
#include "moving_shapes.glsl"

// What shapes that move take from light that was looked up, and what they send in its place: each hides its share of the hemisphere, or of the lobe.
// Dispatch: see findPixel.
layout(local_size_x = 8, local_size_y = 8) in;
layout(constant_id = kTermId) const uint kTerm = kTermDiffuse; // or kTermRough
layout(constant_id = kMovingBoxesId) const bool kBoxes = false; // of boxes, else of round shapes: where lanes are vectors, a branch costs as if all took it
layout(constant_id = kMovingLooksId) const bool kLooks = true; // else what shapes hide is taken for as bright as all the rest
layout(set = 1, binding = kMovingLightBinding, rgba16f) uniform image2D looked; // diffuse: mean of the arriving radiance; rough: radiance to the eye

const float kFarthest = 16.0; // times its radius: a sphere hides 1/256 there
const float kFading = 12.0;   // the same, from where on its share goes to 0
const int kLobes = 3;         // along a capsule, of what is behind it
const float kLeast = 1e-6;    // metres: a surface may go through a shape's middle
const float kLowest = 0.05;   // cosine to the normal of a lobe's axis

shared int low[3], high[3];      // of the tile's points, as ordered()
shared uint near[kMostMovingShapes / 32u]; // shapes, a bit each
shared uint nearShape[kMostMovingShapes];  // the same as a list, in their order, so that sums are the same each time
shared uint nearCount;

/// Integers in the order of the numbers.
int ordered(float x)
{
    int bits = floatBitsToInt(x);
    return bits < 0 ? bits ^ 0x7fffffff : bits;
}
float unordered(int bits) { return intBitsToFloat(bits < 0 ? bits ^ 0x7fffffff : bits); }

/// Shapes that the tile's pixels may see anything of.
void findNear(Pixel p)
{
    uint lane = gl_LocalInvocationIndex;
    if (lane < 3u) low[lane] = 0x7fffffff, high[lane] = -0x7fffffff;
    if (lane < kMostMovingShapes / 32u) near[lane] = 0u;
    if (lane == 0u) nearCount = 0u;
    barrier(); // bounds and bits are empty before the first pixel's
    if (p.surface)
        for (int axis = 0; axis < 3; ++axis)
        {
            atomicMin(low[axis], ordered(p.position[axis]));
            atomicMax(high[axis], ordered(p.position[axis]));
        }
    barrier(); // all pixels are within the bounds
    if (low[0] <= high[0])
    {
        vec3 a = vec3(unordered(low[0]), unordered(low[1]), unordered(low[2])), b = vec3(unordered(high[0]), unordered(high[1]), unordered(high[2]));
        for (uint i = lane; i < movingHead.count; i += 64u)
        {
            vec3 away = max(max(a - movingShape[i].centre, movingShape[i].centre - b), vec3(0.0));
            float reach = kFarthest * movingShape[i].reach;
            if ((movingShape[i].kind == kShapeIsBox) == kBoxes && dot(away, away) < reach * reach) atomicOr(near[i / 32u], 1u << (i % 32u));
        }
    }
    barrier(); // all shapes have been asked
    for (uint i = lane; i < movingHead.count; i += 64u)
    {
        if ((near[i / 32u] >> (i % 32u) & 1u) == 0u) continue;
        uint place = bitCount(near[i / 32u] & ((1u << (i % 32u)) - 1u));
        for (uint word = 0u; word < i / 32u; ++word) place += bitCount(near[word]);
        nearShape[place] = i;
        atomicMax(nearCount, place + 1u);
    }
    barrier(); // the list is whole
}

float shareOfHemisphere(MovingShapeData s, vec3 at, vec3 normal)
{
    if (kBoxes) return shareOfBox(at, s.half_, normal);
    return shareOfRound(at, s.half_.x, s.half_.y, normal);
}

/// What a shape covers of a plane that faces a point, square metres.
float areaFrom(MovingShapeData s, vec3 at)
{
    vec3 across = abs(at) / max(length(at), kLeast);
    return kBoxes ? 4.0 * dot(across, s.half_.yzx * s.half_.zxy)
                  : kBrdfPi * s.half_.x * s.half_.x + 4.0 * s.half_.x * s.half_.y * sqrt(max(1.0 - across.y * across.y, 0.0));
}

/// The first of a leaf's probes that nothing hides a point from.
uint probeAt(vec3 point, vec3 normal)
{
    int reads = 0;
    vec3 lifted = point + 0.5 * field.voxel * normal;
    uvec4 ranked = rankedProbesAt(lifted, reads);
    for (int k = 0; k < kRanked; ++k)
        if (!hiddenFromProbe(ranked[k], lifted - probeHeader(ranked[k]).centre)) return ranked[k];
    return ranked.x;
}

/// Radiance that arrives in a lobe. Cost: up to 12 reads.
vec3 radianceOf(uint probe, vec3 point, Lobe lobe)
{
    vec3 fromProbe = point - probeHeader(probe).centre;
    float met = seenAlong(probe, fromProbe, lobe.direction);
    return lobeRadiance(probe, fromProbe, lobe, met > 0.0 ? met : guessedAlong(probe, fromProbe, lobe.direction));
}

/// Mean radiance that a shape hides from a point, by the cosine: an even disc's deviation is half of its radius.
/// @param from  the point in the shape's own axes
vec3 hiddenBy(MovingShapeData s, vec3 from, uint asked, vec3 point, vec3 normal)
{
    int lobes = kBoxes || !(s.half_.y > 0.0) ? 1 : kLobes;
    float radius = sqrt(areaFrom(s, from) / (kBrdfPi * float(lobes)));
    vec3 sum = vec3(0.0);
    float weights = 0.0;
    for (int i = 0; i < lobes; ++i)
    {
        vec3 to = vec3(0.0, s.half_.y * (float(2 * i + 1) / float(lobes) - 1.0), 0.0) - from;
        if (lobes == 1) to = -from;
        float away = max(length(to), kLeast);
        vec3 direction = fromShape(s, to / away);
        float cosine = dot(direction, normal);
        if (cosine < kLowest) direction = normalize(direction + (kLowest - cosine) * normal), cosine = kLowest;
        sum += cosine * radianceOf(asked, point, Lobe(direction, 0.5 * atan(radius / away)));
        weights += cosine;
    }
    return sum / weights;
}

/// Of the lobe, as a square hides it that faces the point and is as large as the shape is from there.
float shareOfReflection(MovingShapeData s, vec3 at, Pixel p)
{
    float area = areaFrom(s, at);
    TangentFrame tangents = tangentFrame(p.normal), facing = tangentFrame(normalize(fromShape(s, -at) + kLeast * p.normal));
    vec3 middle = toTangent(tangents, fromShape(s, -at)), view = toTangent(tangents, p.view);
    vec3 u = toTangent(tangents, facing.tangent) * (0.5 * sqrt(area)), v = toTangent(tangents, facing.bitangent) * (0.5 * sqrt(area));
    view.z = max(view.z, 1e-4); // a shading normal may turn away from the eye
    return polygonOfLobe(ggxAlpha(p.brdf.roughness), normalize(view), middle - u - v, middle + u - v, middle + u + v, middle - u + v);
}

void main()
{
    uint index = workgroupIndex();
    if (index >= tileCount(kTerm)) return; // the whole workgroup
    ivec2 at = tileOrigin(kTerm, index) + ivec2(gl_LocalInvocationID.xy);
    Pixel p = readPixel(min(at, ivec2(frame.size) - 1));
    p.surface = p.surface && all(lessThan(at, ivec2(frame.size)));
    findNear(p);
    if (!p.surface || isNotOf(kTerm, termsOf(p))) return;
    vec3 point = sconceFieldPoint(p.position);
    uint asked = kNoProbe;
    float open = 1.0;
    vec3 sent = vec3(0.0), hidden = vec3(0.0);
    for (uint n = 0u; n < nearCount; ++n)
    {
        uint i = nearShape[n];
        MovingShapeData s = movingShape[i];
        vec3 from = toShape(s, p.position - s.centre);
        float far = length(from) / s.reach;
        if (far > kFarthest || isOfShape(s, from, toShape(s, p.normal))) continue;
        float share = kTerm == kTermDiffuse ? shareOfHemisphere(s, from, toShape(s, p.normal)) : shareOfReflection(s, from, p);
        share *= open * clamp((kFarthest - far) / (kFarthest - kFading), 0.0, 1.0); // of what the others leave open
        if (!(share > 0.0)) continue;
        open -= share;
        sent += share * radianceOfShape(i, fromShape(s, distanceTo(s, from).outward));
        if (!kLooks || kTerm != kTermDiffuse) continue;
        if (asked == kNoProbe) asked = probeAt(point, p.normal);
        hidden += share * hiddenBy(s, from, asked, point, p.normal);
    }
    if (open == 1.0) return;
    vec4 before = imageLoad(looked, at);
    vec3 left = asked != kNoProbe ? max(before.rgb - hidden, vec3(0.0)) : open * before.rgb;
    if (kTerm == kTermRough) sent *= specularColor(lobesAt(p.brdf, dot(p.normal, p.view)));
    imageStore(looked, at, storedLight(vec4(left + sent, before.a)));
}
