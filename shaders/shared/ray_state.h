// Where a ray through the light field stands: what the tracer's parts hand to each other. Shared text, see probe_trace.h. All lengths are field
// units (light_field.h).

SCONCE_CONST uint kMiss = 0u;
SCONCE_CONST uint kHit = 1u;
SCONCE_CONST uint kUnknown = 2u;

SCONCE_CONST int kPhaseChoose = 0;
SCONCE_CONST int kPhaseSegment = 1;
SCONCE_CONST int kPhaseMarch = 2;
SCONCE_CONST int kPhaseFine = 3;
SCONCE_CONST int kPhaseDone = 4;

SCONCE_CONST uint kEventCrossing = 0u;  // ran into a surfel's plane
SCONCE_CONST uint kEventFirst = 1u;     // was behind it from the start in this probe
SCONCE_CONST uint kEventContinued = 2u; // came to it behind it, over a surface that goes on

SCONCE_CONST int kMarchSteps = 16;   // march steps a turn of the state machine, before other lanes' events get their turn
SCONCE_CONST int kShortSteps = 8;    // the same where a lane whose ray has ended waits for the next one (shortTurns())
SCONCE_CONST int kMaxSegments = 16;  // pieces of a ray in one probe: 5 faces a line can cross, twice (free ball), and slack for rounding

SCONCE_CONST int kFaceNone = -1;     // the ray ends with the segment
SCONCE_CONST int kFaceToSearch = -2; // the segment starts anywhere in the probe's map: the free ball was left, or the probe just entered

SCONCE_CONST real kOpinionOpen = real(-1.0);  // no hit was in so large a texel that a nearer probe is asked about it
SCONCE_CONST real kOpinionAsked = real(-2.0); // a ray asks once

/// What never changes. (Ray is a host's, in world space.)
struct FieldRay
{
    vec3 origin;    // field space
    vec3 direction; // unit
    vec3 normal;    // see Ray::normal
    real tMax;      // where it leaves the field
};

/// Whom it asked, and from where on it asks again.
struct Asked
{
    TriedProbes tried;
    real tClear;       // t at which the tried set was last cleared
    real back;         // how much before t the next probe starts: the last one's texel there, a silhouette is not known better
    real opinionT;     // t of a hit that a nearer probe is asked about, else kOpinionOpen or kOpinionAsked
    real opinionReach; // the nearer probe must meet it, or come to a dead end, up to here
};

/// Of the probe it is in.
struct Visit
{
    uint probe;
    vec3 relative; // the ray's origin relative to the probe's centre
    real freeBall; // radius about the centre with nothing in it
    real tEntered; // the ray's t at its entry
    int segments;  // so far
    bool fresh;    // no texel of this probe has been passed yet
};

/// Piece of the ray on a face, and where the march stands on it.
struct Segment
{
    real ta;
    real tb;
    int face;
    int nextFace;   // face behind the side plane the ray leaves through, or kFace...
    uint faceWords; // first word of the face
    vec2 P;         // pixel at s = 0
    vec2 dP;        // mirrored so that both are >= 0
    vec2 iP;        // 1 / dP
    real q0;
    real dq;
    real tq0;
    real dtq;
    bool mirrorX;   // whether P.x was counted from the other side
    bool mirrorY;
    int ix;         // texel that the march is in
    int iy;
    int ex;         // last texel
    int ey;
    int level;
    real s;
    real sEnd;      // end of the texel of the fine event
    uint word;      // that texel
};

/// What a hit met, of all probes; of a ray that none has answered yet, what hides it from one of them.
struct Surfel
{
    vec2 pixel;  // unmirrored, of `face`
    uint word;
    uint probe;  // kNoProbe: none was met
    int face;
    real extent; // of the texel on its surface, field units
    uint event;  // kEvent...: how it was met
};

struct Cost
{
    int handoffs;
    int distanceReads;
    int indexReads;
};

struct RayState
{
    FieldRay ray;
    real t;      // reached so far: everything before is known to be free
    int phase;
    uint status;
    Asked asked;
    Visit visit;
    Segment segment;
    Surfel surfel;
    Cost cost;
};
