#version 460
#extension GL_EXT_scalar_block_layout : require
layout(local_size_x = 1) in;
layout(set = 0, binding = 0) uniform sampler2DArray source;
layout(set = 0, binding = 1, std430) writeonly buffer Result { vec4 result[]; };
layout(set = 0, binding = 2, scalar) uniform Where { vec3 place[4]; float level[4]; };
void main()
{
    uint i = gl_GlobalInvocationID.x;
    result[i] = textureLod(source, place[i], level[i]);
}
