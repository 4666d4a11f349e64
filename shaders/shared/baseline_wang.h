// One probe of baseline W': Wang et al. 2019, "Fast Non-uniform Radiance Probe Placement and Tracing", section 4.2, rebuilt: a min/max
// chain made per cube face, each level resampled to the octahedral map, marched along the octants' straight lines. What the paper leaves
// open is chosen thus: the hit rule, the ray's radial distance and the hand-over are B0+'s; a segment starts at level 4, climbs a level
// when it leaves a cell through a border of the coarser one (Uludag 2014 climbs after every free cell: more reads), and goes down a level
// where a cell's minimum blocks; a cell whose maximum lies nearer than the ray by more than the greatest thickness ends the probe as
// UNKNOWN at once; levels of fewer than 8 cells a side are left out.
// Words of a probe: level 0 (radial distance, normal) as in the plain octahedral chart, then levels 1, 2, ... info.topLevel of (min r,
// max r), rounded outward. Shared text, see baseline_b0.h.

SCONCE_CONST int kWangStart = 4;
SCONCE_CONST real kB0Thickest = real(0.97); // metres: the greatest value that the hit rule's thickness can take

SCONCE_FN uint wangLevelOffset(int level)
{
    uint width = field.faceSize >> level;
    return (field.faceSize * field.faceSize - width * width) / 3u * 4u; // sum of a geometric series: each level has 1/4 of the words
}

SCONCE_FN bool wangSegment(SCONCE_INOUT(B0Ray) ray, SCONCE_IN(B0Line) line)
{
    int level = min(kWangStart, int(field.topLevel));
    ivec2 texel = b0FirstTexel(line);
    real l = real(0.0);
    vec3 va = b0LineDirection(line, l);
    real ra = b0Radial(ray, va);
    real tNearest = -dot(ray.relative, ray.direction); // where the ray passes the probe
    for (int i = 0; i < 8 * int(field.faceSize); ++i) // every turn enters a texel or goes down a level
    {
        ivec2 next;
        real le = min(b0Leave(line, texel, level, l, next), real(1.0));
        int width = int(field.faceSize) >> level;
        uint word = distanceWord(ray.probe * field.wordsPerProbe + wangLevelOffset(level) + uint((texel.y >> level) * width + (texel.x >> level)));
        ++ray.reads;
        vec3 vb = b0LineDirection(line, le);
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
