/* half.h: half-precision numbers, as images hold them. */
#ifndef WD_BASE_HALF_H
#define WD_BASE_HALF_H

#include <stdint.h>

/* Rounded to nearest; |x| from 2^-14 to 65504, smaller ones become 0 and larger ones 65504. */
uint16_t wd_half_of(float x);

#endif
