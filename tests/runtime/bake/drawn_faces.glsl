#extension GL_EXT_scalar_block_layout : require
layout(scalar, push_constant) uniform Push
{
    mat4 clipFromRelative;
    vec3 centre;
};
