#version 460
// into[i] = 3 from[i] + 1
layout(local_size_x = 64) in;
layout(set = 0, binding = 0, std430) readonly buffer From { uint from[]; };
layout(set = 0, binding = 1, std430) writeonly buffer Into { uint into[]; };
void main()
{
    uint i = gl_GlobalInvocationID.x;
    if (i < into.length())
        into[i] = 3 * from[i] + 1;
}
