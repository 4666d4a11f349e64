// Rows of workgroups that so many look-ups take. After shared/frame.h.
uint rowsOfLookUps(uint count) { return (count + 64u * kTileRow - 1u) / (64u * kTileRow); }
