#pragma once

#include <filesystem>
#include <string>

#include "bench/reference/reference.h"

namespace sconce
{

/// How long a reference is traced, and where it is kept.
struct KeepReference
{
    std::filesystem::path folder;
    double until = 0.0;                     // own relMSE of its indirect terms, by its noise; 0: the first batch is enough
    uint32_t mostPaths = knobs::paths.most; // a pixel, from which on no batch is added, whatever the noise
};

/// What was kept, and what it took.
struct KeptReference
{
    Reference reference;
    uint64_t paths = 0;   // a pixel
    double seconds = 0.0; // of tracing, in whichever runs
};

/// A reference kept by all that it depends on: scene, camera, size, settings, and what the path tracer answers. Batches of paths are added,
/// each as large as all before, until its noise is small enough; each is kept, so that whoever asks again, or was interrupted, goes on from
/// there. Another path tracer begins anew.
/// @param scene  key of the rays' scene, keyOf()
/// @param first  its `samples` are the first batch, a multiple of 4 where it has parts
/// Errors: as renderReference(), fileError.
Result<KeptReference> keptReference(const RayScene& rays, const std::string& scene, const ReferenceSettings& first,
                                    const KeepReference& keep, const Progress& progress);

} // namespace sconce
