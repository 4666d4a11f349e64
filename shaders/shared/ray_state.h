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
SCONCE_CONST int kMaxSegments = 16;  // pieces of a ray in one probe: 5 faces a line can cross, twice (free ball), and slack for rounding

struct RayState
{
    vec3 origin;    // field space
    vec3 direction; // unit
    vec3 startNormal; // see Ray::normal
    real tMax;
    real t;         // reached so far: everything before is known to be free
    int phase;
    uint status;
    // probe
    uint probe;
    vec3 relative;  // origin relative to the probe's centre
    real freeBall;  // radius about the centre with nothing in it
    int face;
    int segments;   // of this probe so far
    bool fresh;     // no texel of this probe has been passed yet
    real back;      // how much before t the next probe starts: the last one's texel there, a silhouette is not known better
    real opinionT;  // t of a hit that a nearer probe is asked about, -1: none yet, -2: it was asked
    real tEntered;  // t when the ray entered the probe
    real opinionReach; // the nearer probe must meet it, or come to a dead end, up to here
    real tClear;    // t at which the tried set was last cleared
    TriedProbes tried;
    // segment of the ray on a face
    real ta;
    real tb;
    int nextFace;   // face behind the side plane the ray leaves through, -1: end of the ray, -2: the free ball, look again
    uint faceWords; // first word of the face
    vec2 P;
    vec2 dP;        // mirrored so that both are >= 0
    vec2 iP;
    real q0;
    real dq;
    real idq;
    real tq0;
    real dtq;
    int mirrorX;    // 0 or -1
    int mirrorY;
    int ix;
    int iy;
    int ex;
    int ey;
    int level;
    real s;
    real sEnd;      // end of the current texel
    uint word;      // texel of the fine event
    real wordSize;  // extent of that texel on its surface, field units
    uint event;     // kEvent...: how the last surfel was met
    // what happened
    int handoffs;
    int distanceReads;
    int indexReads;
    // where the last surfel was met
    vec2 pixel;     // unmirrored, of `face`
    uint hitWord;
    uint lastProbe; // probe of the last surfel, kNoProbe: none
    int lastFace;
};
