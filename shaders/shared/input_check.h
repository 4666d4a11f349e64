// How a frame's inputs are compared with the light field: check_inputs.comp and who runs it. Scalar layout.
#include "shared/gpu_types.h"
#ifndef SCONCE_INPUT_CHECK_H
#define SCONCE_INPUT_CHECK_H
SCONCE_STRUCTS_BEGIN

const uint kCheckGuessesBinding = 4u;
const uint kCheckCountsBinding = 5u;
const uint kCheckGroup = 64u;
const uint kMostGuesses = 16u;

// What a depth may mean.
const uint kDepthReversed = 0u;
const uint kDepthForward = 1u;   // 0 at the near plane
const uint kDepthAlongAxis = 2u; // metres
const uint kDepthAlongRay = 3u;  // metres

// What a normal may mean; the order of InputCounts::agree.
const uint kNormalWorld = 0u;
const uint kNormalPacked = 1u;   // 0 to 1 for -1 to 1
const uint kNormalInward = 2u;   // on the other side
const uint kNormalOfView = 3u;   // x right, y up, z towards the viewer
const uint kNormalOfViewAway = 4u; // z away from the viewer
const uint kNormalMeanings = 5u;

// What a base colour may be; the order of InputCounts::tint.
const uint kColorLinear = 0u;
const uint kColorEncoded = 1u; // sRGB, not decoded
const uint kColorTwice = 2u;   // decoded twice
const uint kColorMeanings = 3u;

/// What a frame's matrix and depth may mean.
struct InputGuess
{
    mat4 worldFromClip; // to the field's world
    mat4 turn;          // from the host's world axes to the field's, for normals
    uint depth;         // kDepth...
};
SCONCE_CHECK_SIZE(InputGuess, 132);

struct InputCounts
{
    uvec2 size;             // of the images, pixels
    uint pixels;            // looked at
    uint empty;             // depth 0
    uint broken;            // a number that is none, or beyond all sense
    uint shown[kMostGuesses]; // with a surface, by each guess
    uint met[kMostGuesses];   // that lies where a probe sees one
    uint facing[kMostGuesses]; // of like normal, as the host gives it
    uint cells[kMostGuesses];  // bits of the cells that they lie in: all in one is no picture
    uint known;             // on a surface that a probe sees, by the chosen guess
    uint agree[kNormalMeanings];
    uint uneven;            // normals that are not unit
    uint colors;            // base colours outside of 0 to 1
    uint metals;            // metallic, the same
    uint roughnesses;       // the same
    uint lit;               // whose albedo the field tells
    uint tint[kColorMeanings]; // that it is
};

struct InputCheckPush
{
    uint every;  // a pixel of so many along each axis
    uint chosen; // guess of the second pass; kMostGuesses: the first pass, which tries all
    uint guesses;
};
SCONCE_CHECK_SIZE(InputCheckPush, 12);

SCONCE_STRUCTS_END
#endif
