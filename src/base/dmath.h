/* dmath.h: elementary functions that give the same bits on every compiler, library and
 * optimisation level: range reduction and polynomials in + - * /, nothing from libm but exact
 * operations. Relative error below 1e-12 over the ranges used here. */
#ifndef WD_BASE_DMATH_H
#define WD_BASE_DMATH_H

double wd_dsin(double x); /* |x| < 1e6 */
double wd_dcos(double x);
void wd_dsincos(double x, double *sine, double *cosine); /* both, for little more than one */
double wd_dexp(double x); /* clamped to finite results */
double wd_dlog(double x); /* x > 0; -1e308 otherwise */
double wd_dpow(double x, double y); /* x >= 0; 0^y is 0 for y > 0 */
double wd_datan2(double y, double x); /* (-pi, pi]; 0 for (0, 0) */

#define WD_PI 3.14159265358979323846

#endif
