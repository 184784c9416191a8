#version 460
struct Vertex { vec4 position; vec4 color; };
layout(set = 0, binding = 0, std430) readonly buffer Vertices { Vertex vertices[]; };
void main() { gl_Position = vertices[gl_VertexIndex].position; }
