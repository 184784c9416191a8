#version 460
// One atomic a workgroup: total is the number of workgroups that ran.
layout(local_size_x = 1) in;
layout(set = 0, binding = 0, std430) buffer Total { uint total; uint highest; };
void main()
{
    atomicAdd(total, 1);
    atomicMax(highest, gl_WorkGroupID.x + gl_WorkGroupID.y * gl_NumWorkGroups.x);
}
