// The reflection model of brdf_text.h for everyone's use: in GLSL, and in C++ in float, in namespace sconce.
#include "shared/gpu_types.h"
#ifndef SCONCE_SHARED_BRDF_H
#define SCONCE_SHARED_BRDF_H
#ifdef __cplusplus
namespace sconce::brdf_float
{
using real = float;
using glm::cos; // the float overloads: C's own would compute in double
using glm::cross;
using glm::dot;
using glm::sin;
using glm::sqrt;
using glm::vec2;
using glm::vec3;
#include "shared/brdf_text.h"
} // namespace sconce::brdf_float
namespace sconce
{
using brdf_float::BrdfLobes;
using brdf_float::BrdfSurface;
using brdf_float::BrdfValue;
using brdf_float::distanceAttenuation;
using brdf_float::evaluateBrdf;
using brdf_float::evaluateLobes;
using brdf_float::ggxAlpha;
using brdf_float::ggxDistribution;
using brdf_float::hemisphericalAlbedo;
using brdf_float::isMirror;
using brdf_float::kBrdfPi;
using brdf_float::kMirrorRoughness;
using brdf_float::kSmallestAlpha;
using brdf_float::lobesAt;
using brdf_float::sampleCosine;
using brdf_float::sampleVisibleNormal;
using brdf_float::schlick;
using brdf_float::smithMasking;
using brdf_float::smithVisibility;
using brdf_float::specularColor;
using brdf_float::spotAttenuation;
using brdf_float::TangentFrame;
using brdf_float::tangentFrame;
using brdf_float::toTangent;
using brdf_float::toWorld;
using brdf_float::viewerOfLobes;
using brdf_float::visibleNormalPdf;
using brdf_float::whiteShares;
using glm::vec2;
using glm::vec3;
} // namespace sconce
#else
#include "shared/brdf_text.h"
#endif
#endif
