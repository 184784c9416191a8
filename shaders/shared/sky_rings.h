/* sky_rings.h: rings of the sky, each told by rays of one elevation: three above 30 degrees, even in the squared cosine,
 * and below three as wide as each other, for below crowns low light comes in at the edges of stands. */
#ifndef WD_SHARED_SKY_RINGS_H
#define WD_SHARED_SKY_RINGS_H

#define WD_SKY_RINGS 6
#define WD_SKY_RING_SINES 0.93541435f, 0.79056942f, 0.61237244f, 0.42261826f, 0.25881905f, 0.08715574f
/* Shares of what an even sky sends to upright faces from above 30 degrees, and from below. */
#define WD_SKY_RINGS_HIGH 0.148f, 0.317f, 0.535f, 0.0f, 0.0f, 0.0f
#define WD_SKY_RINGS_LOW 0.0f, 0.0f, 0.0f, 0.30f, 0.34f, 0.36f

/* And of what it sends to level ground, from all of it. */
#define WD_SKY_RINGS_LEVEL 0.25f, 0.25f, 0.25f, 0.133f, 0.087f, 0.030f

/* See struct wd_crown_shade. */
#define WD_SHADE_SINE 0.6f

#endif
