#pragma once

// Sconce for hosts: all of the C++ API. Installed as this one file, with what it includes of the library written into it; beside it lie
// shaders/sconce.glsl and its like, for shaders, and the headers that GLSL and C++ share.
//
// A host keeps its instance, device, queue and command buffers. What it gets are handles: they keep alive what they need, so that they may
// be moved, copied where they can be, and destroyed in any order and on any thread, once the GPU has finished with them. Calls on one
// Device and on what was made from it are the host's to serialise. Work that they record goes to HostVulkan::queue, outside rendering, in
// the order of recording and each once, for what is recorded next relies on it: an object whose work was dropped is made anew. It leaves
// the compute bindings, sets 0 and 1 and push constants, its own. Objects are of the Device that their field was loaded on. Two Devices may
// be used from two threads; a thread that loads fields for one that draws them has a Device of its own by Device::forThread().

#include <array>
#include <cstdint>
#include <filesystem>
#include <memory>
#include <span>
#include <string>
#include <vector>

#include <glm/gtc/quaternion.hpp>
#if defined(GLM_FORCE_QUAT_DATA_WXYZ) || defined(GLM_FORCE_QUAT_CTOR_XYZW)
#error "sconce.h: quaternions of the library are as GLM has them by default; include it without GLM_FORCE_QUAT_DATA_WXYZ and its like"
#endif

#include "base/knobs.h"
#include "base/progress.h"
#include "base/result.h"
#include "runtime/bake/probe_faces.h"
#include "runtime/field/quality.h"
#include "runtime/frame/effect_plan.h"
#include "runtime/frame/g_buffer.h"
#include "runtime/vulkan/gpu_timer.h"
#include "runtime/vulkan/host_vulkan.h"
#include "scene/exact_rays.h"
#include "scene/light_groups.h"
#include "scene/scene_check.h"
#include "shaders/shared/frame.h"
#include "shaders/shared/light_field.h"

namespace sconce
{

#define SCONCE_VERSION_MAJOR 0
#define SCONCE_VERSION_MINOR 1
#define SCONCE_VERSION_PATCH 0

struct Version
{
    uint32_t major = SCONCE_VERSION_MAJOR, minor = SCONCE_VERSION_MINOR, patch = SCONCE_VERSION_PATCH;
    bool operator==(const Version&) const = default;
};
/// Of the library that was linked; Version() is that of this header.
Version libraryVersion();

class Gpu;

/// A host's device, and what the library makes for itself on it: functions, memory, a command buffer for uploads. A shared handle, for one
/// thread at a time.
class Device
{
public:
    /// @param header  leave it out: a library of another major or minor version than this header is refused
    /// Errors: badArgument (a handle is missing, the queue's family, the version), missingFeature (named: of the physical device; whether
    /// the host has switched it on can't be asked), deviceFailure.
    static Result<Device> create(const HostVulkan& host, Version header = {});
    /// For another thread: with memory, its budget and compiled passes in common, so that either draws what the other has loaded. Both
    /// submit to the host's queue, which is then the host's to lock (HostVulkan::submit). Errors: outOfMemory, deviceFailure.
    Result<Device> forThread() const;
    uint64_t bytes() const; // of device memory that the library holds now, all threads' together
    /// Debugging, where the environment has SCONCE_NAN_SCAN=1: what passes of the library that the host has submitted since the last call
    /// wrote of NaN and infinity. Once the GPU is done with a frame, before the next is recorded. Errors: deviceFailure (the first: pass,
    /// buffer, place).
    Status nanFindings() const;
    Gpu& gpu() const { return *shared; } // for the library's own folders

private:
    explicit Device(std::shared_ptr<Gpu> made) : shared(std::move(made)) {}
    std::shared_ptr<Gpu> shared;
};

/// A light field on the device: the maps, the octree's 3D texture and the descriptor set that shaders/sconce.glsl expects. A shared
/// handle: copies are the same field.
class LightField
{
public:
    /// Reads and uploads a .sconce file, by submits to HostVulkan::queue that it waits for. Errors: fileError, badInput (names the damaged
    /// block, or the version), badArgument (knobs out of range: named), outOfMemory (names the bytes), missingFeature (a limit that it
    /// exceeds), deviceFailure.
    /// @param resident  0: all of it is on the device. Else so many probes' maps, which are nearly all of it, at a time: FieldStream reads
    /// those that
    ///                  frames ask for; without them light comes from what is known in the open. badArgument where lights may move
    static Result<LightField> load(const Device& device, const std::filesystem::path& file, const Quality& quality = {},
                                   uint32_t resident = knobs::resident.value);

    VkDescriptorSetLayout layout() const;  // for a host's own pipeline layouts, at set SCONCE_FIELD_SET
    VkDescriptorSet descriptorSet() const; // the field's resources
    /// Values of the first constant ids of a pass that includes shaders/sconce.glsl: `farBounds`, `order`, and whether it holds
    /// radiance, are fixed in a pass when it is made.
    std::array<uint32_t, 2> constants() const;
    const gpu::LightFieldInfo& info() const;
    uint64_t deviceBytes() const;
    bool holdsRadiance() const;           // as rays need it
    bool holdsPrefiltered() const;        // as rough reflections need it
    bool holdsSurfaceLight() const;       // diffuse light where surfaces are
    bool holdsPatches() const;            // as diffuse light by patches needs them
    const std::string& sceneName() const; // Scene::name of what it was baked from, to tell whether it is the scene that is drawn
    /// Names of the effects that its scene called for when it was baked (SceneEffect::name).
    const std::vector<std::string>& effects() const;
    /// What a frame in its scene needs of indirect light, by these effects: what isn't called for costs nothing.
    IndirectEffects effectsOfFrames() const;
    /// A frame's view with every default, of this field; its camera, seed and what it follows are the host's.
    gpu::FrameView frameView(uint32_t width, uint32_t height) const;
    /// Takes effect for command buffers submitted after it; submits an upload and waits. Not while the GPU reads the field. Errors:
    /// badArgument (names the knob).
    Status setQuality(const Quality& quality);

    struct State; // of the library's own folders
    explicit LightField(std::shared_ptr<State> made);
    State& state() const { return *shared; }

private:
    std::shared_ptr<State> shared;
};

/// A frame's view whose camera, now and before, is in a world of the host's own, with other axes, of the other hand or in other units, as
/// the field has it. The G-buffer's normals stay in the host's world: passes turn them. Other lengths are in metres as they were.
/// @param fieldFromHost  turns, mirrors, moves and scales alike in all directions: of a left-handed world with z up in centimetres, as
///                       Unreal's is, that takes (x, y, z) to 0.01 (x, z, y)
/// Errors: badArgument (a matrix that does more).
Result<gpu::FrameView> inFieldsWorld(gpu::FrameView view, const mat4& fieldFromHost);

/// Worlds larger than memory: keeps those maps of a light field on the device that frames ask for, of a field that was loaded with room for
/// some. Passes note which probes they would read; a thread reads these from the file, those asked for most first, and record() copies
/// what it has read to where the maps are that are asked for least, or not at all and are the farthest from the eye. Where a probe's maps
/// are missing, the next of a place's ranked probes answers, then light that is known in the open: a picture is less sharp for some frames,
/// and never waits. Host memory: probesAFrame (framesInFlight + 2) probes' maps, with each light group's share of their radiance.
/// Move-only; it keeps its light field.
class FieldStream
{
public:
    struct Desc
    {
        uint32_t probesAFrame = 2;   // copied by one record at most; 1 to 64
        uint32_t framesInFlight = 3; // the GPU is done with a record after so many further ones; 1 to 8
    };
    struct Counts
    {
        uint32_t resident = 0; // probes whose maps are there
        uint32_t missing = 0;  // that are asked for and aren't
        uint64_t read = 0;     // probes read from the file so far
        bool full = false;     // there is no room for what is missing: all that are there are asked for as often, or nearly
    };

    /// Errors: badArgument (a number out of range; a field that is whole, or has a stream), outOfMemory.
    static Result<FieldStream> create(const Device& device, const LightField& field, const Desc& desc);
    FieldStream(FieldStream&&) noexcept;
    FieldStream& operator=(FieldStream&&) noexcept;
    ~FieldStream(); // waits for the thread

    /// Records copies of what has been read, before the frames that show it; nothing where nothing has. Begins by waiting for whoever reads
    /// the maps, ends with the barrier that lets any later stage read them. Never waits for the file, allocates, throws or submits.
    /// @param eye  world, metres
    /// @param timer  optional; scope "stream maps"
    void record(VkCommandBuffer cmd, vec3 eye, GpuTimer* timer = nullptr) noexcept;
    Counts counts() const;
    /// Of the file: the first that failed, and which probe; its maps stay away, and frames go on without them. fileError, badInput (names
    /// the damaged block), outOfMemory.
    Status status() const;
    uint64_t deviceBytes() const; // besides the field's

    struct State; // of the library's own folders
    explicit FieldStream(std::unique_ptr<State> made);
    State& state() const { return *owned; }

private:
    std::unique_ptr<State> owned;
};

/// The groups of lights that a field was baked with, as a host switches, dims and colours them: in the frame in which that is recorded, and
/// without a ray, since light is linear. A host without them has none of their passes or bytes. Move-only; it keeps its light field.
class LightGroups
{
public:
    /// Uploads the groups' shares. Of a field that streams those of radiance come with its maps, by a FieldStream that is created after
    /// this and goes before it.
    /// @param file  that `field` was loaded from
    /// Errors: as LightField::load(), and badArgument where the file has no groups or is of another field, or the field has LightGroups,
    /// LiveLight, which switches groups itself, or a stream.
    static Result<LightGroups> load(const Device& device, const LightField& field, const std::filesystem::path& file);
    LightGroups(LightGroups&&) noexcept;
    LightGroups& operator=(LightGroups&&) noexcept;
    ~LightGroups();

    std::vector<std::string> names() const;
    /// @param weights  of each group in the order of names(): times its light as it was baked, in red, green, blue; 0 to 1e6
    /// Errors: badArgument (the group by name, and its weight); what was set before stays.
    Status set(std::span<const vec3> weights);
    /// Records what `set` changed since the last record, before the frames that show it; nothing where nothing changed. Begins by waiting
    /// for whoever reads the field, ends with the barrier that lets any later stage read it. Never allocates, throws or submits. The host's
    /// own direct light is the host's to change. IndirectLight's `temporal` needs FrameView::follows = kFollowsChange for kChangeFrames
    /// frames. Cost: a read of each word of each share and a write of each of the field's.
    /// @param timer  optional; scope "light groups"
    void record(VkCommandBuffer cmd, GpuTimer* timer = nullptr) noexcept;
    uint64_t deviceBytes() const;

    struct State; // of the library's own folders
    explicit LightGroups(std::unique_ptr<State> made);
    State& state() const { return *owned; }

private:
    std::unique_ptr<State> owned;
};

inline constexpr size_t kMostLiveLights = 1024;

/// The light that a field with live links is in.
struct LightState
{
    std::vector<Light> lights; // of no extent: sun, points, spots; world, metres; at most kMostLiveLights, added, moved and removed at will
    std::vector<vec3> groups;  // weights of LiveLight::groups(), as LightGroups::set() takes them; empty: as they were baked
};

/// How much of a field's light a record may make anew. Light in the open, of hidden places and finer texels, and its sum with the groups'
/// are of the whole field in each record that changes some.
struct RelightBudget
{
    uint32_t probes = 0;  // that are lit in one record; 0: all that need it
    uint32_t bounces = 2; // that their light makes in it; 1 to 16
    vec3 eye{0.0f};       // world, metres: where fewer are lit, half of them are those nearest to it, the others take turns
};

/// The lights of a field that was baked with live links (BakeDesc::liveLinks), as a host moves, adds and removes them: direct light by rays
/// through the light field, then bounces, all by links that the bake has kept, so that still light is still. Diffuse light, irradiance,
/// prefiltered radiance and what rays find follow. What the bake has of groups is switched, dimmed and coloured, too. A host without it has
/// none of its passes or bytes. Move-only; it keeps its light field.
class LiveLight
{
public:
    /// Uploads what light needs to move. Before IndirectLight and whatever else traces the field is made, since that then looks for live
    /// light. Light begins as black where it is live, and is settled once settled() says so.
    /// @param file  that `field` was loaded from
    /// Errors: as LightField::load(), and badArgument where the file has no live links or is of another field, or the field has LightGroups
    /// or LiveLight.
    static Result<LiveLight> load(const Device& device, const LightField& field, const std::filesystem::path& file);
    LiveLight(LiveLight&&) noexcept;
    LiveLight& operator=(LiveLight&&) noexcept;
    ~LiveLight();

    std::span<const Light> lights() const;   // as set last, or as baked
    std::vector<std::string> groups() const; // names of those of the field
    /// Errors: badArgument (the light or the group by name, and what is wrong with it); what was set before stays.
    Status set(const LightState& state);
    /// Whether a record has nothing to do.
    bool settled() const;
    /// Records what is to be done, before the frames that show it; nothing once light is settled. Begins by waiting for whoever reads the
    /// field, ends with the barrier that lets any later stage read it. Never allocates, throws or submits. The host's own direct light is
    /// the host's to change; IndirectLight's `temporal` needs FrameView::follows = kFollowsChange as long as light is not settled. Cost a
    /// probe with the default of surface texels: 64,896 shadow rays a light where lights have moved, and 16,224 reads a link and bounce.
    /// @param timer  optional; scopes "live direct", "live bounces", "live filter", "live places", "live lobes" and "light groups"
    void record(VkCommandBuffer cmd, const RelightBudget& budget = {}, GpuTimer* timer = nullptr) noexcept;
    uint64_t deviceBytes() const;

    struct State; // of the library's own folders
    explicit LiveLight(std::unique_ptr<State> made);
    State& state() const { return *owned; }

private:
    std::unique_ptr<State> owned;
};

/// What moves, as indirect light sees it: it hides light from what is about it, and rays meet it. The host draws it, with shadows of its
/// own lights; a figure is some capsules, a door a box. Its surface is lit as whatever no probe knows, by the light in the open about it.
/// Rays of RayTracer and of a host's own shaders don't meet it. World, metres.
struct MovingShape
{
    enum class Kind : uint32_t
    {
        sphere,
        capsule, // along its y
        box
    };
    Kind kind = Kind::sphere;
    vec3 centre{0.0f};
    glm::quat turn{1.0f, 0.0f, 0.0f, 0.0f}; // its axes to the world's, unit
    vec3 half{0.5f};     // box: from the middle to its faces; else x: radius, y: from the middle to the ends' centres; all above 0
    vec3 albedo{0.5f};   // of light that it scatters, [0,1]: base colour, without metal
    vec3 emission{0.0f}; // W/(m^2 sr), to all sides; what the host's own lights make of it may be added
    float slack =
        -1.0f; // how far what is drawn of it may lie off it: such a surface isn't hidden by it; below 0: kSlackOfShape of its size
};
inline constexpr float kSlackOfShape = 0.1f; // of the radius of the sphere about it

/// Records one frame's indirect light into the host's command buffer. Made once for a size; recording never allocates, throws or submits.
/// Move-only; it keeps its light field.
class IndirectLight
{
public:
    struct Desc
    {
        uint32_t width = 0, height = 0;                // pixels, 1 to the device's largest image
        IndirectEffects effects;                       // LightField::effectsOfFrames() has those that the scene calls for
        uint32_t traceEvery = knobs::traceEvery.value; // trace one pixel of so many, of reflections and of traced diffuse light, and make
                                                       // the rest from it: shaders/reconstruct.comp. Mirrors are traced at every pixel
        uint32_t surfaceProbes = knobs::surfaceProbes.value; // whose light is blended at a look-up of surface light
        bool counts = false;                                 // write what each pixel's ray cost: an image of 16 bytes a pixel
        uint32_t movingShapes = 0;                           // that move at a time, up to 256; 0: no pass, nor bytes, of them
    };
    /// An image of the frame's size in VK_IMAGE_LAYOUT_GENERAL, to be sampled or read as a storage image; all null when the effect is off.
    struct Output
    {
        VkImage image = VK_NULL_HANDLE;
        VkImageView view = VK_NULL_HANDLE;
        VkFormat format = VK_FORMAT_UNDEFINED;
    };

    /// Submits to HostVulkan::queue and waits, some times. Errors: badArgument (size, or an effect whose maps the field doesn't hold:
    /// named), outOfMemory, missingFeature, deviceFailure.
    static Result<IndirectLight> create(const Device& device, const LightField& field, const Desc& desc);
    IndirectLight(IndirectLight&&) noexcept;
    IndirectLight& operator=(IndirectLight&&) noexcept;
    ~IndirectLight();

    /// Binds the G-buffer; before the first record and whenever its views change. Not between a record and the end of what it recorded on
    /// the GPU: a host that alternates two G-buffers while frames are in flight makes an IndirectLight of each. Views that are read are not
    /// null.
    void setInputs(const FrameInputs& inputs);
    /// What moves, from the next recorded frame on; none before the first call. With the effect `temporal`, FrameView::follows =
    /// kFollowsChange while anything moves. Cost: of a pixel grows with the shapes within 16 times their size of its tile; a ray asks every
    /// eighth shape at least.
    /// Errors: badArgument (more than Desc::movingShapes, or the first shape that is none: named); what was set before stays.
    Status setShapes(std::span<const MovingShape> shapes);
    /// Record frames in the order in which they are shown, where the effect `temporal` or `screenTrace` is on. The G-buffer must be visible
    /// to compute shaders' sampled reads by then. Begins by waiting for whoever reads the outputs of the frame before, ends with the
    /// barrier that lets any later stage read these.
    /// @param view  of Desc's size, which is drawn whatever it says; LightField::frameView() gives it every default
    /// @param timer  optional; scopes "classify tiles", "gather light", "surface light", "diffuse trace", "glossy trace", "mirror trace",
    ///               "diffuse fill", "glossy fill", "glossy denoise", "moving shapes", "lamp light"
    void record(VkCommandBuffer cmd, const gpu::FrameView& view, GpuTimer* timer = nullptr) noexcept;

    // An image holds values where a pixel has the term (sconceTermsOf() of shaders/sconce_frame.glsl) and anything elsewhere;
    // sconceComposeIndirect() there makes a picture of them. RGBA16F, in steps of 6e-8 at least; light beyond gpu::kMostLight, 65,504, is
    // stored as that.
    uint32_t made() const;  // bits 1 << gpu::kTermDiffuse... of the terms whose images aren't null
    Output diffuse() const; // rgb cosine-weighted mean of the arriving radiance, without albedo: of all but the host's own lights where it
                            // is read from surface light or traced; else of what surfaces reflect alone: no light straight from emitters or
                            // sky. a, of surface light: SurfaceLight::probes, what it is from
    Output rough() const;   // rgb radiance reflected to the eye, BRDF included; as the next two
    Output glossy() const;
    Output mirror() const; // may be the image of glossy(): no pixel has both
    Output counts() const; // RGBA32UI: probe, hand-offs, reads, unknown rays; of the traced terms
    uint64_t deviceBytes() const;

    struct State; // of the library's own folders
    explicit IndirectLight(std::unique_ptr<State> made);
    State& state() const { return *owned; }

private:
    std::unique_ptr<State> owned;
};

/// Looks for what hosts get wrong with a frame: a depth that isn't reversed, a matrix that is transposed, mirrored, in centimetres or of
/// another frame, normals of the view, colours that were decoded twice, and more. It compares the G-buffer with the surfaces that the field
/// knows, and tries what else it could mean. For development: it makes a pass, submits it twice and waits. Most of the picture should be
/// what the field was baked from.
/// @param inputs  visible to compute shaders' sampled reads
/// @return  a sentence each with its remedy, the gravest first; none: nothing was found
/// Errors: badArgument (a view is missing, a frame of no pixels), outOfMemory, deviceFailure.
Result<std::vector<std::string>> validateInputs(const Device& device, const LightField& field, const FrameInputs& inputs,
                                                const gpu::FrameView& view);

/// Traces lists of rays through a light field: for a host's own questions. A shared handle; it keeps its light field.
class RayTracer
{
public:
    /// Errors: outOfMemory, deviceFailure.
    static Result<RayTracer> create(const Device& device, const LightField& field);

    /// Records the trace of `count` rays; ends with the barrier that lets any stage read the hits. Any number of records may be in one
    /// command buffer and in flight at once. Never allocates, throws or submits.
    /// @param rays  device address of gpu::Ray[count], visible to compute shaders by then
    /// @param hits  device address of gpu::RayHit[count], of this record alone until it is done
    void record(VkCommandBuffer cmd, VkDeviceAddress rays, VkDeviceAddress hits, uint32_t count) const noexcept;
    /// Uploads, traces and downloads, in pieces of at most 2^18 rays; waits for the result. Misuse: spans of different length assert.
    /// @param milliseconds  of the trace passes alone, by the GPU's clock; 0 when the queue has none
    /// Errors: outOfMemory, deviceFailure.
    Status trace(std::span<const gpu::Ray> rays, std::span<gpu::RayHit> hits, double* milliseconds = nullptr) const;

    struct State; // of the library's own folders
    explicit RayTracer(std::shared_ptr<State> made);
    State& state() const { return *shared; }

private:
    std::shared_ptr<State> shared;
};

/// What a light field is baked with. Ranges and prices: knobs above. The command's `bake` has further ones.
struct BakeDesc
{
    uint32_t resolution = knobs::resolution.value; // texels a side of an octahedral map; cube faces have half; memory grows with its square
    uint32_t bounces = knobs::bounces.value;       // times the baked light is re-injected at most, 0..64; each costs one gather a texel
    float converged = knobs::converged.value; // stop earlier, after a bounce that adds less than this share of all light, 0..1; 0: never
    uint32_t surfaceTexels = knobs::surfaceTexels.value; // a side of a face of surface light, 26, 52 or 104; 0: none, probes light surfaces
    uint32_t surfaceRays = knobs::surfaceRays.value;     // of each, that gather its light, 1..1024: noise falls with the root, time grows
    float surfaceRefined = knobs::surfaceRefined.value;  // share of them that are resolved 4 times as finely each way, 0..0.25; with `rays`
    uint32_t lampTexels = knobs::lampTexels.value;       // a side of the shadow maps of lamps, 512..8192; 0: no lamps; with `rays`
    std::string effects = "auto";                        // as planEffects()
    // To the scene's triangles, that gather surface light. Null: through the light field, on the device, without lamps, refined texels and
    // live links.
    const ExactRays* rays = nullptr;
    uint32_t liveLinks = knobs::liveLinks.value;    // of each surface texel, so that LiveLight moves lights; 0: they stay
    float submissionMs = knobs::submissionMs.value; // that the device is held at once at most, as far as passes can be cut
    bool compact = false; // maps in blocks: 0.4 of their memory, and rays, which unpack them, take longer; without liveLinks and groups
    bool lit = true;      // false: geometry and material alone, with live links: no light until LiveLight has recorded
    ProbeFaces* faces = nullptr;        // draws what probes see, without liveLinks and groups; null: the scene's triangles are drawn
    std::vector<LightGroupDesc> groups; // that LightGroups changes; all other light is one more; none: all light is one, as it is baked
};

/// Bakes a scene at given probes on the host's device and writes the field to a file, whole or not at all. Submits and waits: on a thread
/// beside one that draws it is given a Device::forThread(). What it takes of device memory counts towards the device's budget, with all
/// else that is held. Same input, same driver: same bytes.
/// @param probes  world, metres; 1 to 65,535
/// Errors: badArgument (settings, probes: named), badInput (scene; with rays, drawn faces that show another world), outOfMemory (with the
/// numbers), deviceFailure, fileError, cancelled.
Status bakeLightField(const Device& device, const Scene& scene, std::span<const vec3> probes, const BakeDesc& desc,
                      const std::filesystem::path& file, const Progress& progress = {});

} // namespace sconce
