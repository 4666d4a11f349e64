// Where a ray meets what the picture shows: its way over the host's depth, and the light that the frame before drew there. What no probe knows, an actor, a
// thing that was moved, is reflected all the same, and what probes see coarsely is as fine as pixels. After gbuffer_read.glsl, light_field.glsl and lamps.glsl.
// In the manner of McGuire and Mara 2014, "Efficient GPU Screen-Space Ray Tracing", section 3: depth is linear along a ray over the picture, too. Other than
// there no thickness is guessed: a ray meets a surface where it meets a pixel's plane within the pixel, and of one that has gone behind something the field says more.
layout(set = 1, binding = kPictureBeforeBinding) uniform texture2D pictureBefore; // rgb: radiance to the eye
layout(scalar, set = 1, binding = kScreenBinding) uniform SconceScreen { mat4 clipFromWorld; }; // of this frame, w > 0 before the eye

const int kScreenSteps = 64;         // reads of depth at most, until one is behind a surface; over 4,000 pixels
const float kScreenFirst = 1.5;      // pixels from the ray's own to the first step
const float kScreenGrowth = 0.15;    // of the way so far, a step's length; at least a pixel
const int kScreenHalvings = 10;      // of the step that went behind a surface
const float kScreenNearest = 0.05;   // of the ray's start from the eye's plane, that a ray towards the eye is followed to
const float kScreenEdge = 0.03;      // of the picture, over which its edge hands over to the field
const float kScreenSame = 2e-3;      // of the diagonal, within which both have met one surface
const float kScreenSure = 1.0;       // pixels from a pixel's middle up to which the ray meets its plane
const float kScreenUnsure = 2.5;     // and beyond which it doesn't
const float kScreenOff = 0.25;       // pixels' widths off that plane, up to which the picture shows it there; at twice as many it doesn't
const float kScreenMostSure = 0.95;  // 0.965 and more of those not beyond the field's hit are right (tests); below 1, too, so that what mirrors show of each other fades
const float kScreenMostBright = 4.0; // times what the field has for the same surface: more is what the eye alone is sent

/// A ray's way over the picture, along which place and depth are linear.
struct ScreenWay
{
    vec2 start;    // pixels
    vec2 step_;    // a pixel long
    float pixels;  // that it goes on for, within the picture; 0: it can't be followed
    float depth, depthStep;
};

ScreenWay screenWay(vec3 origin, vec3 direction, float longest)
{
    ScreenWay way;
    way.pixels = 0.0;
    vec4 a = clipFromWorld * vec4(origin, 1.0), d = clipFromWorld * vec4(direction, 0.0);
    if (!(a.w > 0.0)) return way;
    float far = d.w < 0.0 ? min(longest, (kScreenNearest - 1.0) * a.w / d.w) : longest;
    vec4 b = a + far * d;
    vec3 from = a.xyz / a.w, to = b.xyz / b.w;
    vec2 size = vec2(frame.size), across = 0.5 * (to.xy - from.xy) * size;
    float whole = length(across);
    if (!(whole > kScreenFirst && whole < 1e9)) return way;
    way.start = (0.5 * from.xy + 0.5) * size;
    way.step_ = across / whole;
    vec2 edge = mix(vec2(0.0), size, greaterThan(way.step_, vec2(0.0)));
    vec2 left = mix(vec2(whole), (edge - way.start) / way.step_, greaterThan(abs(way.step_), vec2(1e-6)));
    way.pixels = min(whole, min(left.x, left.y));
    way.depth = from.z;
    way.depthStep = (to.z - from.z) / whole;
    return way;
}

ivec2 pixelAlong(ScreenWay way, float along) { return clamp(ivec2(way.start + along * way.step_), ivec2(0), ivec2(frame.size) - 1); }
/// Whether the ray is before all that the picture shows there.
bool isBefore(ScreenWay way, float along) { return way.depth + along * way.depthStep >= depthAt(pixelAlong(way, along)); }

/// In pixels; far off the picture where the place is behind the eye.
vec2 screenPlace(vec3 place)
{
    vec4 clip = clipFromWorld * vec4(place, 1.0);
    return clip.w > 0.0 ? (0.5 * clip.xy / clip.w + 0.5) * vec2(frame.size) : vec2(-1e6);
}

/// What a ray meets in the picture.
struct ScreenHit
{
    float t;    // metres
    float sure; // [0,1]: about the chance that it is met there; 0: nothing is
    vec3 place; // world
    float width; // of a pixel there, metres
    bool hidden; // it went behind something before, where more may stand
    ivec2 at;    // the pixel that shows it
};

/// Whether the ray meets the surface of a pixel: its plane, within the pixel.
/// @param along  where the ray is behind what the picture shows, within a pixel of where it was not
void meetPixel(vec3 origin, vec3 direction, ScreenWay way, float along, inout ScreenHit hit)
{
    ivec2 at = pixelAlong(way, along);
    Pixel q = readPixel(at);
    if (!q.surface) return;
    vec3 plane = geometricNormalAt(at, q); // shading normals may face a ray that leaves the surface
    if (dot(plane, plane) < 0.5) plane = q.normal;
    float facing = dot(plane, direction), away = dot(plane, origin - q.position);
    float width = distance(q.position, worldAt(at + ivec2(1, 0), q.clip.z));
    if (!(facing < 0.0 && away > 0.0)) return;
    float t = -away / facing;
    vec3 place = origin + t * direction;
    // That pixel's plane goes on beside it, and so may the surface: the picture must show it where the ray meets the plane.
    vec2 seen = screenPlace(place);
    ivec2 there = ivec2(floor(seen));
    float depth = depthAt(there);
    if (!(depth > 0.0)) return;
    float off = abs(dot(plane, worldAt(there, depth) - q.position)) / width;
    float sure = (1.0 - smoothstep(kScreenSure, kScreenUnsure, distance(seen, vec2(at) + 0.5))) * (1.0 - smoothstep(kScreenOff, 2.0 * kScreenOff, off));
    if (!(sure > 0.0)) return;
    hit = ScreenHit(t, kScreenMostSure * sure, place, width, hit.hidden, at);
}

ScreenHit screenHit(vec3 origin, vec3 direction, float longest)
{
    ScreenHit hit;
    hit.sure = hit.t = 0.0;
    hit.hidden = false;
    ScreenWay way = screenWay(origin, direction, longest);
    float last = 0.0;
    bool before = true;
    for (int i = 0; i < kScreenSteps && last < way.pixels; ++i)
    {
        float along = min(i == 0 ? kScreenFirst : last + max(1.0, kScreenGrowth * last), way.pixels);
        bool now = isBefore(way, along);
        if (before && !now)
        {
            float low = last, high = along;
            for (int k = 0; k < kScreenHalvings && high - low > 0.5; ++k)
            {
                float middle = 0.5 * (low + high);
                if (isBefore(way, middle)) low = middle;
                else high = middle;
            }
            meetPixel(origin, direction, way, high, hit);
            if (hit.sure > 0.0) return hit;
            hit.hidden = true;
        }
        before = now;
        last = along;
    }
    return hit;
}

/// Whether the picture shows that nothing is at a place: all that it shows about there is farther off.
/// @param by  metres, at least
bool isSeenToBeEmpty(vec3 place, float by)
{
    ivec2 at = ivec2(floor(screenPlace(place)));
    if (any(lessThan(at, ivec2(1))) || any(greaterThanEqual(at, ivec2(frame.size) - 1))) return false;
    float nearest = distance(place, frame.eye) + by;
    for (int i = 0; i < 5; ++i)
    {
        ivec2 tap = at + (i == 0 ? ivec2(0) : i == 1 ? ivec2(1, 0) : i == 2 ? ivec2(-1, 0) : i == 3 ? ivec2(0, 1) : ivec2(0, -1));
        float depth = depthAt(tap);
        if (depth > 0.0 && distance(worldAt(tap, depth), frame.eye) < nearest) return false;
    }
    return true;
}

/// Of a place that the picture shows, from the frame before; a: how far it is inside of that, [0,1]; 0 too where it holds no number.
vec4 lightBefore(vec3 place)
{
    vec4 clip = frame.clipFromWorldBefore * vec4(place, 1.0);
    vec2 ndc = clip.xy / clip.w;
    if (!(clip.w > 0.0) || any(greaterThanEqual(abs(ndc), vec2(1.0)))) return vec4(0.0);
    vec2 inside = clamp(0.5 * (1.0 - abs(ndc)) / kScreenEdge, 0.0, 1.0);
    vec2 pixel = (0.5 * ndc + 0.5) * vec2(frame.size) - 0.5;
    ivec2 low = ivec2(floor(pixel)), most = ivec2(frame.size) - 1;
    vec2 f = pixel - vec2(low);
    vec3 sum = vec3(0.0);
    for (int i = 0; i < 4; ++i)
    {
        ivec2 tap = ivec2(i & 1, i >> 1);
        vec2 weight = mix(1.0 - f, f, vec2(tap));
        sum += weight.x * weight.y * texelFetch(pictureBefore, clamp(low + tap, ivec2(0), most), 0).rgb;
    }
    bool isNumber = dot(abs(sum), vec3(1.0)) < 1e30;
    return isNumber ? vec4(sum, inside.x * inside.y) : vec4(0.0);
}

/// How much of what a surface sends is the same to all sides.
float scatteredShare(Pixel p)
{
    BrdfLobes lobes = lobesAt(p.brdf, dot(p.normal, p.view));
    float scattered = kBrdfPi * luminance(lobes.diffuse), reflected = luminance(specularColor(lobes));
    return scattered / max(scattered + reflected, 1e-6);
}

/// Puts what the picture shows in place of what the field has met, as far as it is sure: where it is nearer, where the picture shows that nothing is at the
/// field's hit, and where both have met one surface, whose texels are finer here. What is not drawn is taken for not there.
void meetScreen(vec3 origin, vec3 direction, inout RayHit hit)
{
    if (frame.follows == 0u) return; // there is no frame before
    float same = kScreenSame * field.diagonal * field.scale;
    float known = hit.status == kHit ? hit.t : 1e30, whole = 2.0 * field.diagonal * field.scale;
    float farthest = known < whole && !isSeenToBeEmpty(hit.position, same) ? known + same : whole;
    ScreenHit seen = screenHit(origin, direction, farthest);
    if (!(seen.sure > 0.0) || seen.t > farthest) return;
    bool isSame = abs(seen.t - known) <= same;
    if (!isSame && seen.hidden) return;
    // A lamp's own light is in no ray: it is evaluated where it falls. Pixels beside it have some of it, too.
    vec3 point = (seen.place - field.origin) / field.scale;
    bool isLamp = lampCount > 0u && isOfLamp(point, field.diagonal, max(same, 1.5 * seen.width) / field.scale);
    if (isSame && isLamp) return;
    vec4 light = lightBefore(seen.place);
    float sure = seen.sure * light.a;
    if (isLamp) light.rgb = vec3(0.0);
    if (isSame)
    {
        sure *= scatteredShare(readPixel(seen.at));
        light.rgb *= min(1.0, kScreenMostBright * luminance(hit.radiance) / max(luminance(light.rgb), 1e-30));
    }
    hit.radiance = mix(hit.radiance, light.rgb, sure);
    if (sure < 0.5) return;
    hit.status = kHit;
    hit.t = seen.t;
    hit.position = seen.place;
    hit.normal = frame.fieldFromNormals * texelFetch(gNormalRoughness, seen.at, 0).xyz;
}
