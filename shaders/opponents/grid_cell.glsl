// The eight corners of a point's cell in a uniform grid of probes.
const int kGridCorners = 8;

struct GridCell
{
    ivec3 low;
    vec3 alpha; // the point's place in the cell, [0,1]
};

GridCell gridCellOf(vec3 point)
{
    vec3 at = (point - field.gridOrigin) / field.gridStep;
    ivec3 last = max(ivec3(field.gridX, field.gridY, field.gridZ) - 2, ivec3(0));
    GridCell cell;
    cell.low = clamp(ivec3(floor(at)), ivec3(0), last);
    cell.alpha = clamp(at - vec3(cell.low), 0.0, 1.0);
    return cell;
}

/// The probe of a corner (bits xyz) and its part of the cell along each axis; false for a corner beyond the grid.
bool gridCorner(GridCell cell, int corner, out uint probe, out vec3 part)
{
    ivec3 bits = ivec3(corner & 1, (corner >> 1) & 1, corner >> 2);
    ivec3 at = cell.low + bits;
    probe = uint(at.x) + field.gridX * (uint(at.y) + field.gridY * uint(at.z));
    part = mix(1.0 - cell.alpha, cell.alpha, vec3(bits));
    return all(lessThan(at, ivec3(field.gridX, field.gridY, field.gridZ)));
}
