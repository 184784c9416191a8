/* types.h: lets one header be compiled as C17 and as GLSL. Every struct both sides see, and every
 * piece of mathematics that must agree on both, lives in shaders/shared and begins with this.
 *
 * Struct members: WD_VEC3(name) and friends; uint32_t, int32_t and float are written as such.
 * GLSL blocks use the scalar layout, so C and GLSL offsets are equal.
 * Functions: WD_FUNC float wd_f(float x) { ... }; use only + - * on floats where both sides must
 * agree to the bit, and mark such locals WD_PRECISE so that no fused multiply-add creeps in. */
#ifndef WD_SHARED_TYPES_H
#define WD_SHARED_TYPES_H

#ifdef __STDC_VERSION__
#include <assert.h>
#include <stdbool.h>
#include <stdint.h>
#define WD_VEC2(name) float name[2]
#define WD_VEC3(name) float name[3]
#define WD_VEC4(name) float name[4]
#define WD_MAT4(name) float name[4][4]
#define WD_FUNC static inline
#define WD_PRECISE
#define WD_STATIC_ASSERT_SIZE(type, bytes) static_assert(sizeof(struct type) == (bytes), #type)
#else
#extension GL_EXT_scalar_block_layout : require
#define uint32_t uint
#define int32_t int
#define WD_VEC2(name) vec2 name
#define WD_VEC3(name) vec3 name
#define WD_VEC4(name) vec4 name
#define WD_MAT4(name) mat4 name
#define WD_FUNC
#define WD_PRECISE precise
#define WD_STATIC_ASSERT_SIZE(type, bytes)
#endif

#endif
