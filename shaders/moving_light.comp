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
layout(set = 1, binding = kMovingLightBinding, rgba32f) uniform image2D looked; // diffuse: mean of the arriving radiance; rough: radiance to the eye

const float kFarthest = 16.0; // times its radius: a sphere hides 1/256 there
const float kFading = 12.0;   // the same, from where on its share goes to 0

shared int low[3], high[3];      // of the tile's points, as ordered()
shared uint near[kMostMovingShapes / 32u]; // shapes, a bit each

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
            if (dot(away, away) < reach * reach) atomicOr(near[i / 32u], 1u << (i % 32u));
        }
    }
    barrier(); // all shapes have been asked
}

float shareOfHemisphere(MovingShapeData s, vec3 at, vec3 normal)
{
    if (s.kind == kShapeIsBox) return shareOfBox(at, s.half_, normal);
    return shareOfRound(at, s.half_.x, s.half_.y, normal);
}

/// Of the lobe, as a square hides it that faces the point and is as large as the shape is from there.
float shareOfReflection(MovingShapeData s, vec3 at, Pixel p)
{
    vec3 across = abs(at) / length(at);
    float area = s.kind == kShapeIsBox ? 4.0 * dot(across, s.half_.yzx * s.half_.zxy)
                                       : kBrdfPi * s.half_.x * s.half_.x + 4.0 * s.half_.x * s.half_.y * sqrt(max(1.0 - across.y * across.y, 0.0));
    TangentFrame tangents = tangentFrame(p.normal), facing = tangentFrame(normalize(fromShape(s, -at)));
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
    float open = 1.0;
    vec3 sent = vec3(0.0);
    for (uint word = 0u; word < kMostMovingShapes / 32u; ++word)
        for (uint bits = near[word]; bits != 0u; bits &= bits - 1u)
        {
            uint i = 32u * word + uint(findLSB(bits));
            MovingShapeData s = movingShape[i];
            vec3 from = toShape(s, p.position - s.centre);
            float far = length(from) / s.reach;
            if (far > kFarthest || isOfShape(s, from, toShape(s, p.normal))) continue;
            float share = kTerm == kTermDiffuse ? shareOfHemisphere(s, from, toShape(s, p.normal)) : shareOfReflection(s, from, p);
            share *= clamp((kFarthest - far) / (kFarthest - kFading), 0.0, 1.0);
            if (!(share > 0.0)) continue;
            open *= 1.0 - share;
            sent = (1.0 - share) * sent + share * radianceOfShape(i, fromShape(s, distanceTo(s, from).outward));
        }
    if (open == 1.0) return;
    vec4 before = imageLoad(looked, at);
    if (kTerm == kTermRough) sent *= specularColor(lobesAt(p.brdf, dot(p.normal, p.view)));
    imageStore(looked, at, vec4(open * before.rgb + sent, before.a));
}
