#version 460
// Work that takes a time proportional to `rounds`.
layout(local_size_x = 64) in;
layout(set = 0, binding = 0, std430) buffer Values { uint values[]; };
layout(push_constant) uniform Push { uint rounds; };
void main()
{
    uint x = gl_GlobalInvocationID.x;
    for (uint i = 0; i < rounds; i++)
        x = (x ^ (x >> 15)) * 0x2c1b3c6du + i;
    values[gl_GlobalInvocationID.x] = x;
}
