#pragma once

#include "runtime/field/tracer_cpu.h"
#include "shaders/opponents/baseline.h"

namespace sconce::twin
{

/// The opponents' shader text on the CPU; `kind` is one of shaders/opponents/baseline.h. The field is one that baselineField() made.
/// Refers to the field: keep that alive. Safe from many threads.
template <class Real, std::uint32_t kind> struct BaselineTwin : LightFieldTwin<Real>
{
    // The shader text names all of these unqualified, and unqualified names are not looked up in a template's dependent base.
    using Base = LightFieldTwin<Real>;
    using Base::Base;
    using real = Real;
    using uint = std::uint32_t;
    using vec2 = glm::vec<2, Real>;
    using vec3 = glm::vec<3, Real>;
    using vec3f = glm::vec3;
    using RayHit = gpu::RayHit;
    using TraceResult = typename Base::TraceResult;
    using Base::addTried;
    using Base::answer;
    using Base::canTrace;
    using Base::directionFromOctahedral;
    using Base::distanceWord;
    using Base::field;
    using Base::fieldExit;
    using Base::halfToReal;
    using Base::keepLastTried;
    using Base::kHit;
    using Base::kLookAheads;
    using Base::kMaxTried;
    using Base::kMiss;
    using Base::kNoProbe;
    using Base::kProgress;
    using Base::lookAhead;
    using Base::noneTried;
    using Base::wasTried;
    using TriedProbes = typename Base::TriedProbes;
    using Base::holdsPrefiltered;
    using Base::holdsRadiance;
    using Base::kRanked;
    using Base::kUnknown;
    using Base::octahedralFromDirection;
    using Base::prefilteredRadiance;
    using Base::probeHeader;
    using Base::radianceWord;
    using Base::rankedProbesAt;
    using Base::unpackNormal8;
    using Base::unpackRadiance;
    static constexpr uint kBaseline = kind;
    static constexpr uint kBaselineB0 = gpu::kBaselineB0;
    static constexpr uint kBaselineB0PlusOctree = gpu::kBaselineB0PlusOctree;
    static constexpr uint kBaselineWang = gpu::kBaselineWang;

#include "shaders/opponents/baseline_b0.h"

#include "shaders/opponents/baseline_wang.h"

#include "shaders/opponents/baseline_trace.h"
};

} // namespace sconce::twin
