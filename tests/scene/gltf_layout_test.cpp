#include "scene/gltf_layout.h"

#include <gtest/gtest.h>
#include <nlohmann/json.hpp>

namespace sconce
{
namespace
{

using Json = nlohmann::json;

constexpr int kFloat = 5126, kUnsignedShort = 5123;

std::string faultOf(const Json& gltf, const std::vector<uint64_t>& buffers)
{
    const Status status = checkLayout(Json::parse(gltf.dump()), buffers); // as from a file: only there are numbers without sign told apart
    if (status.ok()) return "";
    EXPECT_EQ(status.error().code, ErrorCode::badInput);
    return status.error().message;
}

void expectFault(const std::string& fault, const std::string& part)
{
    EXPECT_NE(fault.find(part), std::string::npos) << '"' << fault << '"';
}

/// Ten vec3 of 4-byte floats, tightly packed at byte 8 of a view of 128 bytes that begins at byte 12 of its buffer.
Json tenVectors()
{
    const Json view = {{"buffer", 0}, {"byteOffset", 12}, {"byteLength", 128}};
    const Json accessor = {{"bufferView", 0}, {"byteOffset", 8}, {"componentType", kFloat}, {"count", 10}, {"type", "VEC3"}};
    return {{"bufferViews", Json::array({view})}, {"accessors", Json::array({accessor})}};
}

TEST(GltfLayout, WhatFitsToTheByteFits)
{
    EXPECT_EQ(faultOf(Json::object(), {}), "");
    EXPECT_EQ(faultOf(tenVectors(), {140}), ""); // 8 + 10 * 12 = 128; 12 + 128 = 140
    Json gltf = tenVectors();
    gltf["bufferViews"][0]["byteStride"] = 13 * 4;
    gltf["bufferViews"][0]["byteLength"] = 8 + 9 * 52 + 12; // the last element needs no stride
    EXPECT_EQ(faultOf(gltf, {12 + 8 + 9 * 52 + 12}), "");
    gltf["accessors"][0]["count"] = 0;
    gltf["accessors"][0]["byteOffset"] = gltf["bufferViews"][0]["byteLength"];
    EXPECT_EQ(faultOf(gltf, {500}), "") << "nothing at the very end";
}

TEST(GltfLayout, OneByteTooManyIsNamed)
{
    expectFault(faultOf(tenVectors(), {139}), "Buffer view 0 ends at byte 140 of a buffer of 139 bytes");
    Json gltf = tenVectors();
    gltf["bufferViews"][0]["byteLength"] = 127;
    expectFault(faultOf(gltf, {140}), "Accessor 0 ends at byte 128 of a buffer view of 127 bytes");
    gltf = tenVectors();
    gltf["accessors"][0]["count"] = 11;
    expectFault(faultOf(gltf, {140}), "Accessor 0 ends at byte 140");
    gltf = tenVectors();
    gltf["bufferViews"][0]["byteStride"] = 8;
    expectFault(faultOf(gltf, {140}), "elements of 12 bytes, more than the stride of 8");
}

// In 32 or even 64 bits these sums would wrap to something small.
TEST(GltfLayout, NumbersThatWouldOverflowAreRefused)
{
    Json gltf = tenVectors();
    gltf["bufferViews"][0]["byteOffset"] = 0xffffffffffffffffull;
    expectFault(faultOf(gltf, {140}), "must be an integer");
    gltf["bufferViews"][0]["byteOffset"] = 1ull << 40;
    expectFault(faultOf(gltf, {140}), "ends at byte");
    gltf = tenVectors();
    gltf["accessors"][0]["byteOffset"] = 0xfffffff0u; // + 120 wraps in 32 bits
    expectFault(faultOf(gltf, {140}), "ends at byte");
    gltf = tenVectors();
    gltf["accessors"][0]["count"] = 0x100000000ull;
    expectFault(faultOf(gltf, {140}), "the limit is 2^32 - 1");
    gltf["accessors"][0]["count"] = 0xffffffffull;
    gltf["bufferViews"][0]["byteStride"] = 252;
    expectFault(faultOf(gltf, {140}), "ends at byte 1082331758108 "); // 8 + (2^32 - 2) 252 + 12
    for (const Json& wrong : {Json(-1), Json(1.5), Json("8"), Json(nullptr), Json(true)})
    {
        gltf = tenVectors();
        gltf["accessors"][0]["byteOffset"] = wrong;
        expectFault(faultOf(gltf, {140}), "byteOffset " + wrong.dump());
    }
}

TEST(GltfLayout, WhatIsNotThereIsNamed)
{
    Json gltf = tenVectors();
    gltf["bufferViews"][0]["buffer"] = 1;
    expectFault(faultOf(gltf, {140}), "Buffer view 0 uses buffer 1 of 1");
    gltf = tenVectors();
    gltf["accessors"][0]["bufferView"] = 1;
    expectFault(faultOf(gltf, {140}), "Accessor 0 uses buffer view 1 of 1");
    for (const char* key : {"buffer", "byteLength"})
    {
        gltf = tenVectors();
        gltf["bufferViews"][0].erase(key);
        expectFault(faultOf(gltf, {140}), std::string("Buffer view 0 has no ") + key);
    }
    for (const char* key : {"componentType", "count"})
    {
        gltf = tenVectors();
        gltf["accessors"][0].erase(key);
        expectFault(faultOf(gltf, {140}), std::string("Accessor 0 has no ") + key);
    }
    gltf = tenVectors();
    gltf["accessors"][0]["type"] = "VEC5";
    expectFault(faultOf(gltf, {140}), "unknown type");
    gltf["accessors"][0]["type"] = "VEC3";
    gltf["accessors"][0]["componentType"] = 5124; // a signed int, which glTF 2.0 left out
    expectFault(faultOf(gltf, {140}), "component type 5124");
    for (const int stride : {6, 256})
    {
        gltf = tenVectors();
        gltf["bufferViews"][0]["byteStride"] = stride;
        expectFault(faultOf(gltf, {140}), "multiple of 4 up to 252");
    }
}

/// Ten vectors of which two are replaced: indices of 2 bytes in view 1, values in view 2.
Json sparse()
{
    Json gltf = tenVectors();
    gltf["bufferViews"].push_back(Json{{"buffer", 1}, {"byteLength", 4}});
    gltf["bufferViews"].push_back(Json{{"buffer", 1}, {"byteOffset", 4}, {"byteLength", 24}});
    gltf["accessors"][0]["sparse"] = {
        {"count", 2}, {"indices", {{"bufferView", 1}, {"componentType", kUnsignedShort}}}, {"values", {{"bufferView", 2}}}};
    return gltf;
}

TEST(GltfLayout, SparseAccessorsAreCheckedLikeTheRest)
{
    EXPECT_EQ(faultOf(sparse(), {140, 28}), "");
    Json gltf = sparse();
    gltf["accessors"][0]["sparse"]["indices"]["componentType"] = 5125;
    expectFault(faultOf(gltf, {140, 28}), "(sparse) ends at byte 8 of a buffer view of 4");
    gltf["accessors"][0]["sparse"]["indices"]["componentType"] = 5122;
    expectFault(faultOf(gltf, {140, 28}), "must be unsigned");
    gltf = sparse();
    gltf["accessors"][0]["sparse"]["values"]["byteOffset"] = 1;
    expectFault(faultOf(gltf, {140, 28}), "(sparse) ends at byte 25 of a buffer view of 24");
    gltf = sparse();
    gltf["accessors"][0]["sparse"]["count"] = 11;
    expectFault(faultOf(gltf, {140, 28}), "replaces 11 of 10");
    for (const char* key : {"indices", "values"})
    {
        gltf = sparse();
        gltf["accessors"][0]["sparse"].erase(key);
        expectFault(faultOf(gltf, {140, 28}), "lacks indices or values");
    }
}

// A fallback view of EXT_meshopt_compression may lie in a buffer without data; reading it is the fault.
TEST(GltfLayout, CompressedDataMayBeThereButNotBeRead)
{
    Json gltf = tenVectors();
    gltf["bufferViews"][0]["extensions"]["EXT_meshopt_compression"] = Json::object();
    expectFault(faultOf(gltf, {0}), "compressed data (meshopt)");
    EXPECT_EQ(faultOf(gltf, {140}), "") << "uncompressed fallback";
    gltf["accessors"] = Json::array();
    EXPECT_EQ(faultOf(gltf, {0}), "");
}

TEST(GltfLayout, ComponentsHaveTheBytesOfTheStandard)
{
    for (const auto& [type, bytes] : {std::pair{5120, 1}, {5121, 1}, {5122, 2}, {5123, 2}, {5124, 0}, {5125, 4}, {5126, 4}, {0, 0}})
        EXPECT_EQ(componentBytes(uint64_t(type)), uint32_t(bytes)) << type;
}

} // namespace
} // namespace sconce
