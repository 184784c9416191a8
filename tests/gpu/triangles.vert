#version 460
struct Vertex { vec4 position; vec4 color; };
layout(set = 0, binding = 0, std430) readonly buffer Vertices { Vertex vertices[]; };
layout(location = 0) out vec4 color;
layout(location = 1) flat out uint triangle;
void main()
{
    gl_Position = vertices[gl_VertexIndex].position;
    color = vertices[gl_VertexIndex].color;
    triangle = gl_VertexIndex / 3;
}
