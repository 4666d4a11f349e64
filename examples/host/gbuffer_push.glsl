#extension GL_EXT_scalar_block_layout : require
layout(scalar, push_constant) uniform Push
{
    mat4 clipFromRelative; // takes (position - eye, 1)
    vec4 baseColor;     // these factors are multiplied by their textures
    vec3 emission;
    float metallic;
    vec3 eye;
    float roughness;
    float normalScale;
    float alphaCutoff; // 0: opaque
    float fieldsZ;     // of a direction along z, in the light field's world: 1 or -1
};
