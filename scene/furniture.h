#pragma once

#include <cstdint>

#include "scene/mesh_builder.h"

namespace sconce
{

/// The palette of the town; indices into Scene::materials.
struct TownMaterials
{
    uint32_t oak, walnut, birch, darkMetal, steel, brass, ceramic, white, linen, screen, soil;
    uint32_t cloth[4], books[6], leaves[3], walls[6], paints[4];
    uint32_t roofTile, asphalt, paving, kerb, cobble, plaster, gloss, parquet, water;
    uint32_t warmLamp, coolLamp, streetLamp;
};

TownMaterials makeTownMaterials(MeshBuilder& mesh);

/// Deterministic small numbers for variation: a 64-bit LCG (Knuth's MMIX constants), its high bits.
class Variation
{
public:
    explicit Variation(uint64_t seed) : state(seed * 2654435761u + 1u) { next(); }
    uint32_t below(uint32_t n) { return uint32_t((next() >> 33) % n); }
    float between(float low, float high) { return low + (high - low) * float(next() >> 40) * (1.0f / 16777216.0f); }

private:
    uint64_t next() { return state = state * 6364136223846793005u + 1442695040888963407u; }
    uint64_t state;
};

// All stand on y = 0 of mesh.place, centred in x and z unless said otherwise; fronts face +z.
void addTable(MeshBuilder& mesh, const TownMaterials& m, vec2 size, float height, uint32_t wood);
void addChair(MeshBuilder& mesh, const TownMaterials& m, uint32_t wood);
void addBookshelf(MeshBuilder& mesh, const TownMaterials& m, uint32_t wood, Variation& vary); // 1.2 x 2.0 x 0.32 m
void addBed(MeshBuilder& mesh, const TownMaterials& m, uint32_t cloth);
void addSofa(MeshBuilder& mesh, const TownMaterials& m, uint32_t cloth);
void addWardrobe(MeshBuilder& mesh, const TownMaterials& m, uint32_t wood);
void addKitchenCounter(MeshBuilder& mesh, const TownMaterials& m); // 2.6 x 0.6 m
void addTableware(MeshBuilder& mesh, const TownMaterials& m);      // on top of a table: y = 0 is the table's top
void addPottedPlant(MeshBuilder& mesh, const TownMaterials& m, Variation& vary);
void addCeilingLamp(MeshBuilder& mesh, const TownMaterials& m, float ceiling, uint32_t lamp);
void addFloorLamp(MeshBuilder& mesh, const TownMaterials& m, uint32_t lamp);
void addTree(MeshBuilder& mesh, const TownMaterials& m, Variation& vary);
void addStreetLamp(MeshBuilder& mesh, const TownMaterials& m);
void addBench(MeshBuilder& mesh, const TownMaterials& m);
void addFountain(MeshBuilder& mesh, const TownMaterials& m);
void addMarketStall(MeshBuilder& mesh, const TownMaterials& m, uint32_t cloth);

} // namespace sconce
