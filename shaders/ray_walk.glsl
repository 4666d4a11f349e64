// A ray of ours turn by turn, for passes that refill their lanes. After light_field.glsl.
struct RayWalk
{
    RayState ray;
    int turnsLeft;
};
#define SCONCE_WALK RayWalk
#define SCONCE_WALK_BEGIN beginWalk
#define SCONCE_WALK_TURN turnOfWalk
#define SCONCE_WALK_ANSWER answerOfWalk

RayWalk beginWalk(vec3 origin, vec3 direction, vec3 normal) { return RayWalk(startRay(sconceFieldPoint(origin), direction, normal), turnLimit()); }

/// @return  whether it has ended
bool turnOfWalk(inout RayWalk walk)
{
    turn(walk.ray);
    return walk.ray.phase == kPhaseDone || --walk.turnsLeft <= 0;
}

RayHit answerOfWalk(vec3 origin, vec3 direction, RayWalk walk) { return answerOf(origin, direction, resultOf(walk.ray)); }
