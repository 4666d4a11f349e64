// One probe of baseline W': Wang et al. 2019, "Fast Non-uniform Radiance Probe Placement and Tracing", section 4.2, rebuilt: a min/max
// chain made per cube face, each level resampled to the octahedral map, marched along the octants' straight lines. What the paper leaves
// open is chosen thus: the hit rule, the ray's radial distance and the hand-over are B0+'s; a segment starts where reads are fewest, climbs a level
// when it leaves a cell through a border of the coarser one (Uludag 2014 climbs after every free cell: more reads), and goes down a level
// where a cell's minimum blocks; a cell whose maximum lies nearer than the ray by more than the greatest thickness ends the probe as
// UNKNOWN at once; levels of fewer than 8 cells a side are left out.
// Words of a probe: level 0 (radial distance, normal) as in the plain octahedral chart, then levels 1, 2, ... info.topLevel of (min r,
// max r), rounded outward. Shared text, see baseline_b0.h.

SCONCE_CONST int kWangStartBelowTop = 4; // levels: the fewest reads of starts at 0 to 6, in the hall and the temple, with maps of 128, 256 and 512 texels
SCONCE_CONST real kB0Thickest = real(0.97); // metres: the greatest value that the hit rule's thickness can take

SCONCE_FN uint wangLevelOffset(int level)
{
    uint width = field.faceSize >> level;
    return (field.faceSize * field.faceSize - width * width) / 3u * 4u; // sum of a geometric series: each level has 1/4 of the words
}

SCONCE_FN vec3 wangDirection(SCONCE_IN(B0Line) line, real l) { return b0Direction(line.P0 + l * line.dP); }

SCONCE_FN ivec2 wangFirstTexel(SCONCE_IN(B0Line) line)
{
    int last = int(field.faceSize) - 1;
    return ivec2(min(max(int(line.P0.x), 0), last), min(max(int(line.P0.y), 0), last));
}

/// Where the line leaves the cell of 2^level texels that holds `texel`, not before l, iP = 1 / line.dP; `next` is the texel it enters there. Texels are
/// stepped as integers, so that each is visited once.
SCONCE_FN real wangLeave(SCONCE_IN(B0Line) line, vec2 iP, ivec2 texel, int level, real l, SCONCE_OUT(ivec2) next)
{
    int mask = (1 << level) - 1;
    ivec2 low = ivec2(texel.x & ~mask, texel.y & ~mask);
    bool right = line.dP.x > real(0.0), up = line.dP.y > real(0.0);
    real lx = (real(right ? low.x + mask + 1 : low.x) - line.P0.x) * iP.x;
    real ly = (real(up ? low.y + mask + 1 : low.y) - line.P0.y) * iP.y;
    real le = max(min(lx, ly), l);
    if (lx <= ly)
    {
        next.x = right ? low.x + mask + 1 : low.x - 1;
        next.y = min(max(int(line.P0.y + le * line.dP.y), low.y), low.y + mask);
    }
    else
    {
        next.x = min(max(int(line.P0.x + le * line.dP.x), low.x), low.x + mask);
        next.y = up ? low.y + mask + 1 : low.y - 1;
    }
    return le;
}

SCONCE_FN bool wangSegment(SCONCE_INOUT(B0Ray) ray, SCONCE_IN(B0Line) line)
{
    int level = max(int(field.topLevel) - kWangStartBelowTop, 0);
    ivec2 texel = wangFirstTexel(line);
    vec2 iP = vec2(abs(line.dP.x) > real(1e-9) ? real(1.0) / line.dP.x : real(-1e9), abs(line.dP.y) > real(1e-9) ? real(1.0) / line.dP.y : real(-1e9));
    real l = real(0.0);
    vec3 va = wangDirection(line, l);
    real ra = b0Radial(ray, va);
    real tNearest = -dot(ray.relative, ray.direction); // where the ray passes the probe
    for (int i = 0; i < 8 * int(field.faceSize); ++i) // every turn enters a texel or goes down a level
    {
        ivec2 next;
        real le = min(wangLeave(line, iP, texel, level, l, next), real(1.0));
        int width = int(field.faceSize) >> level;
        uint word = distanceWord(ray.probe * field.wordsPerProbe + wangLevelOffset(level) + uint((texel.y >> level) * width + (texel.x >> level)));
        ++ray.reads;
        vec3 vb = wangDirection(line, le);
        real rb = b0Radial(ray, vb);
        if (max(ra, rb) < b0Distance(word))
        {
            if (le >= real(1.0) || min(next.x, next.y) < 0 || max(next.x, next.y) >= int(field.faceSize)) return false;
            int above = level + 1;
            if (above <= int(field.topLevel) && ((next.x >> above) != (texel.x >> above) || (next.y >> above) != (texel.y >> above))) level = above;
            texel = next;
            l = le;
            ra = rb;
            va = vb;
            continue;
        }
        if (level == 0)
        {
            b0Stop(ray, line.P0 + real(0.5) * (l + le) * line.dP, word, min(ra, rb), ra * va);
            return true;
        }
        real ta = dot(ra * va - ray.relative, ray.direction);
        real tb = dot(rb * vb - ray.relative, ray.direction);
        if (min(ra, rb) > b0Distance(word >> 16) + kB0Thickest / real(field.scale) && (ta > tNearest || tb < tNearest))
        {
            ray.before = ra * va;
            ray.certain = true;
            return true;
        }
        --level;
    }
    return false;
}
