// A ray of an opponent probe by probe, for passes that refill their lanes. After baseline.glsl.
#define SCONCE_WALK BaselineWalk
#define SCONCE_WALK_BEGIN beginOpponent
#define SCONCE_WALK_TURN turnOfOpponent
#define SCONCE_WALK_ANSWER answerOfOpponent

BaselineWalk beginOpponent(vec3 origin, vec3 direction, vec3 normal) { return beginBaseline(origin, direction); } // no use for the normal

/// @return  whether it has ended
bool turnOfOpponent(inout BaselineWalk walk)
{
    if (walk.asks) askNext(walk);
    return !walk.asks;
}

RayHit answerOfOpponent(vec3 origin, vec3 direction, BaselineWalk walk) { return baselineAnswer(origin, direction, baselineResult(walk)); }
