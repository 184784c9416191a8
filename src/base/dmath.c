#include "base/dmath.h"

#include <math.h>
#include <stdint.h>
#include <string.h>

#define LN2_HIGH 6.93147180369123816490e-01
#define LN2_LOW 1.90821492927058770002e-10

/* Taylor polynomials on [-pi/4, pi/4] by Horner's scheme, its factors as products, which do not
 * wait for divisions: the first dropped terms are below 1e-16. */
static double series(const double *share, double x2)
{
    double sum = 0.0;
    for (int i = 0; i < 8; i++)
        sum = (1.0 + sum) * (-x2 * share[i]);
    return sum;
}

static double sin_poly(double x)
{
    static const double share[8] = {1.0 / (17 * 16), 1.0 / (15 * 14), 1.0 / (13 * 12),
                                    1.0 / (11 * 10), 1.0 / (9 * 8),   1.0 / (7 * 6),
                                    1.0 / (5 * 4),   1.0 / (3 * 2)};
    return x + x * series(share, x * x);
}

static double cos_poly(double x)
{
    static const double share[8] = {1.0 / (16 * 15), 1.0 / (14 * 13), 1.0 / (12 * 11),
                                    1.0 / (10 * 9),  1.0 / (8 * 7),   1.0 / (6 * 5),
                                    1.0 / (4 * 3),   1.0 / (2 * 1)};
    return 1.0 + series(share, x * x);
}

void wd_dsincos(double x, double *sine, double *cosine)
{
    double quarters = x * (2.0 / WD_PI);
    long long turns = (long long)(quarters + (quarters < 0 ? -0.5 : 0.5));
    /* pi/2 in two parts keeps the reduction exact for the arguments used here */
    double rest = (x - (double)turns * 1.57079632673412561417e+00) -
                  (double)turns * 6.07710050650619224932e-11;
    double s = sin_poly(rest), c = cos_poly(rest);
    double across = turns & 1 ? c : s, along = turns & 1 ? s : c;
    *sine = turns & 2 ? -across : across;
    *cosine = (turns + 1) & 2 ? -along : along;
}

double wd_dsin(double x)
{
    double sine, cosine;
    wd_dsincos(x, &sine, &cosine);
    return sine;
}

double wd_dcos(double x)
{
    double sine, cosine;
    wd_dsincos(x, &sine, &cosine);
    return cosine;
}

/* 2^power for a result that is a normal number. */
static double power_of_two(int power)
{
    uint64_t bits = (uint64_t)(power + 1023) << 52;
    double value;
    memcpy(&value, &bits, sizeof value);
    return value;
}

/* Taylor on [-ln 2 / 2, ln 2 / 2] with the factors of Horner's scheme as products, which do not
 * wait for divisions: the first dropped term is below 2e-16. */
double wd_dexp(double x)
{
    static const double share[] = {1.0 / 12, 1.0 / 11, 1.0 / 10, 1.0 / 9, 1.0 / 8, 1.0 / 7,
                                   1.0 / 6,  1.0 / 5,  1.0 / 4,  1.0 / 3, 1.0 / 2, 1.0};
    if (x > 709.0)
        x = 709.0;
    if (!(x > -708.0))
        return 0.0;
    double turns = x * 1.44269504088896340736;
    int power = (int)(turns + (turns < 0 ? -0.5 : 0.5));
    double rest = (x - (double)power * LN2_HIGH) - (double)power * LN2_LOW, sum = 1.0;
    for (int i = 0; i < 12; i++)
        sum = 1.0 + sum * (rest * share[i]);
    return sum * power_of_two(power);
}

double wd_dlog(double x)
{
    if (!(x > 0.0))
        return -1e308;
    int exponent;
    double mantissa = frexp(x, &exponent); /* [0.5, 1) */
    if (mantissa < 0.70710678118654752440) {
        mantissa *= 2.0;
        exponent--;
    }
    /* ln m = 2 atanh((m - 1) / (m + 1)), |argument| < 0.172 */
    double t = (mantissa - 1.0) / (mantissa + 1.0), t2 = t * t, sum = 0.0;
    for (int n = 21; n >= 1; n -= 2)
        sum = sum * t2 + 1.0 / (double)n;
    return (double)exponent * LN2_HIGH + ((double)exponent * LN2_LOW + 2.0 * t * sum);
}

double wd_dpow(double x, double y)
{
    if (y == 0.0)
        return 1.0;
    if (!(x > 0.0))
        return 0.0;
    return wd_dexp(y * wd_dlog(x));
}

/* atan on [0, 1] by two halvings of the angle and the series. */
static double atan_unit(double x)
{
    for (int i = 0; i < 2; i++)
        x = x / (1.0 + sqrt(1.0 + x * x));
    double x2 = x * x, sum = 0.0;
    for (int n = 23; n >= 1; n -= 2)
        sum = 1.0 / (double)n - x2 * sum;
    return 4.0 * x * sum;
}

double wd_datan2(double y, double x)
{
    double ax = fabs(x), ay = fabs(y);
    if (ax == 0.0 && ay == 0.0)
        return 0.0;
    double angle = ay <= ax ? atan_unit(ay / ax) : WD_PI / 2.0 - atan_unit(ax / ay);
    if (x < 0.0)
        angle = WD_PI - angle;
    return y < 0.0 ? -angle : angle;
}
