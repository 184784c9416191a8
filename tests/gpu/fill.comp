#version 460
// values[i] = base + i for i < count, one workgroup of 64 a block, in 2D.
layout(local_size_x = 64) in;
layout(constant_id = 0) const uint factor = 1;
layout(set = 0, binding = 0, std430) buffer Values { uint values[]; };
layout(push_constant) uniform Push { uint base, count; };
void main()
{
    uint group = gl_WorkGroupID.x + gl_WorkGroupID.y * gl_NumWorkGroups.x;
    uint i = group * 64 + gl_LocalInvocationID.x;
    if (i < count)
        values[i] = base + i * factor;
}
