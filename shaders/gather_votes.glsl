// The probes that light a pixel, by the octree: the leaf is looked up at points dithered by a voxel, so that no border of a voxel shows.
const uint kLookUps = 4u; // dithered look-ups a pixel

// The probes that look-ups name, and how often: the weight of a probe doesn't depend on the look-up, so each is asked once and counted as often.
// Vectors with constant indices: an array indexed by each lane is slow where lanes are vectors.
const int kVoted = 2; // times 4: probes kept of up to 16, for the same relMSE of diffuse light within 0.1 % in five scenes (docs/light.md)
struct Votes
{
    uvec4 probe[kVoted];
    vec4 times[kVoted]; // 0 after the last
};

Votes noVotes()
{
    Votes votes;
    for (int i = 0; i < kVoted; ++i) votes.probe[i] = uvec4(kNoProbe), votes.times[i] = vec4(0.0);
    return votes;
}

/// Newest first; the oldest of too many is forgotten.
void vote(inout Votes votes, uint probe)
{
    bool known = false;
    for (int i = 0; i < kVoted; ++i)
    {
        bvec4 same = equal(votes.probe[i], uvec4(probe));
        votes.times[i] += vec4(same);
        known = known || any(same);
    }
    if (known) return;
    for (int i = kVoted - 1; i >= 0; --i)
    {
        votes.probe[i] = uvec4(i > 0 ? votes.probe[i - 1].w : probe, votes.probe[i].xyz);
        votes.times[i] = vec4(i > 0 ? votes.times[i - 1].w : 1.0, votes.times[i].xyz);
    }
}

/// Takes the first out.
uint nextVoted(inout Votes votes, out float times)
{
    uint probe = votes.probe[0].x;
    times = votes.times[0].x;
    for (int i = 0; i < kVoted; ++i)
    {
        votes.probe[i] = uvec4(votes.probe[i].yzw, i + 1 < kVoted ? votes.probe[i + 1].x : kNoProbe);
        votes.times[i] = vec4(votes.times[i].yzw, i + 1 < kVoted ? votes.times[i + 1].x : 0.0);
    }
    return probe;
}

/// Probes that may light a point, and what their say is taken of.
struct Candidates
{
    Votes votes;
    vec3 point; // field space
    vec3 normal;
    vec3 view;
};

/// @param tangents  of the pixel's normal
Candidates candidatesAt(ivec2 at, Pixel p, vec3 point, TangentFrame tangents)
{
    Candidates found = Candidates(noVotes(), point, p.normal, p.view);
    if (!canGather(point, p.normal)) return found;
    for (uint i = 0u; i < kLookUps; ++i)
    {
        vec2 along = (pairOfFrame(uvec2(at), frame.seed, kLookUps, i, 1u) - 0.5) * 2.0 * field.voxel;
        int reads = 0;
        uvec4 r = rankedProbesAt(point + along.x * tangents.tangent + along.y * tangents.bitangent + 0.5 * field.voxel * p.normal, reads);
        vote(found.votes, r.x);
        if (r.y != r.x) vote(found.votes, r.y);
        if (r.z != r.x && r.z != r.y) vote(found.votes, r.z);
        if (r.w != r.x && r.w != r.y && r.w != r.z) vote(found.votes, r.w);
    }
    return found;
}

/// The next probe, and how many look-ups name it. False: there is no more.
bool nextNamed(inout Candidates of, out uint probe, out float times)
{
    times = 0.0;
    probe = kNoProbe;
    if (!(of.votes.times[0].x > 0.0)) return false;
    probe = nextVoted(of.votes, times);
    return true;
}
