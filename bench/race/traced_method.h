#pragma once

#include <memory>
#include <optional>
#include <span>
#include <string>

#include "bench/opponents/baselines.h"
#include "bench/race/trace_score.h"
#include "runtime/field/light_field.h"

namespace sconce
{

/// The 5th, 50th and 95th percentile (nearest rank) of some runs, milliseconds.
struct Times
{
    double p5 = 0.0, median = 0.0, p95 = 0.0;
};
Times timesOf(std::vector<double> milliseconds);

/// Positions 0..count-1 in an order that depends on the seed alone: what makes rays incoherent.
std::vector<uint32_t> shuffledOrder(size_t count, uint64_t seed);

/// What the device answered, as scoreTraces() judges it.
std::vector<TracedRay> tracedRays(std::span<const gpu::RayHit> hits);

/// Which tracer, with its knobs.
struct Tracer
{
    std::optional<Baseline> opponent; // none: ours
    Quality quality;                  // of ours
    uint32_t octahedral = 0;          // of ours: texels a side of octahedral maps to trace instead of the cube faces, 0: the faces
    int distanceBits = 32;            // of ours: bits of a texel (bench/race/distance_format.h)
    uint32_t lowFactor = 0;           // of an opponent, texels; 0: bestLowFactor
};

/// A tracer with the light field it traces, on the device: one row of the bench.
class TracedMethod
{
public:
    /// @param label  what the row is called
    static Result<std::unique_ptr<TracedMethod>> create(Gpu& gpu, FieldData field, const Tracer& tracer, std::string label);
    /// @param what  FILE.sconce, or TRACER=FILE.sconce with `ours`, which knobs of TraceQuality may follow (ours/ranked:2,opinion:0=F) and
    ///              octahedral:N, for maps of N texels a side made from the cube faces, distanceBits:N, for texels of N bits, or an
    ///              opponent's name, which a low factor in texels may follow (b0plus/8=grid.sconce). Without a name: b0plus for octahedral
    ///              maps on a grid, b0plus-octree for others, else ours.
    static Result<std::unique_ptr<TracedMethod>> create(Gpu& gpu, const std::string& what);

    const std::string& name() const { return label; }
    const std::string& file() const { return path; }
    const FieldData& data() const { return field; }
    std::optional<Baseline> baseline() const { return how.opponent; }
    const LightField& lightField() const { return *onDevice; }
    double traceMebibytes() const;    // a probe, of everything the trace reads but the index
    double radianceMebibytes() const; // a probe
    FieldBytes bytes() const;         // of the whole field, as the tracer would keep it

    std::vector<gpu::Ray> raysOf(const RaySet& set) const; // off their surface as the tracer wants them
    bool startsFarther() const;                            // by kFartherStart: they are judged by RaySet::fartherTruth
    Status trace(std::span<const gpu::Ray> rays, std::span<gpu::RayHit> hits) { return tracer->trace(rays, hits); }
    Result<TraceScore> score(const RaySet& set); // traces the set and judges every answer
    void traceOnCpu(std::span<const gpu::Ray> rays, std::span<gpu::RayHit> hits) const;

    /// Uploads the rays that time() traces, at most 2^18: in their order, and in the given one.
    Status prepare(std::span<const gpu::Ray> rays, std::span<const uint32_t> order);
    /// One run over the prepared rays, milliseconds of the trace pass alone by the device's clock. A fast device goes over them again until
    /// kLeastTimed have passed, one pass after the other, and the mean counts: what lasts less is mostly the start of a pass.
    Result<double> time(bool inOrder);
    /// The same with caches that hold nothing of the field: this many bytes are written before each pass, and aren't timed. 0: none are.
    Status writeBetween(uint64_t bytes);
    static constexpr double kLeastTimed = 5.0; // milliseconds
    static constexpr uint32_t kMostPasses = 256;

private:
    Result<double> timePasses(const Buffer& rays, uint32_t passes); // milliseconds of all of them
    void recordPasses(VkCommandBuffer cmd, const Buffer& rays, uint32_t passes);
    explicit TracedMethod(Gpu& device) : gpu(device) {}
    Gpu& gpu;
    std::string label, path;
    Tracer how;
    FieldData field;
    std::optional<LightField> onDevice;
    std::optional<RayTracer> tracer;
    std::optional<GpuTimer> timer;
    Buffer orderedRays, shuffledRays, hitBuffer;
    Buffer between; // written before each pass, or none
    uint32_t timedRays = 0;
    uint32_t orderedPasses = 1, shuffledPasses = 1; // that last kLeastTimed
};

} // namespace sconce
