/* Directional albedo of a GGX conductor (F = 1) by visible-normal sampling: what a compiler makes of it.
 *
 * Built by the system's compiler when `radiokit bench` runs. Dupuy, Benyoub (2023), doi:10.1111/cgf.14867,
 * for the samples; the weight is G2/G1 with height-correlated Smith masking. The generator hashes the seed
 * and the sample's number, so that the answer does not depend on the number of threads.
 */
#include <math.h>
#include <stdint.h>

static inline uint64_t scramble(uint64_t z)
{
    z = (z ^ (z >> 30)) * UINT64_C(0xbf58476d1ce4e5b9);
    z = (z ^ (z >> 27)) * UINT64_C(0x94d049bb133111eb);
    return z ^ (z >> 31);
}

static inline double unit(uint64_t bits) /* to [0, 1) */
{
    return (double)(int64_t)(bits >> 12) * 0x1p-52;
}

/* Put cos(2 pi u) and sin(2 pi u) for u in [0, 1): Taylor series of a quarter of the angle from -pi to pi,
 * which is then doubled twice. The library's functions would keep the loop from being vectorised. */
static inline void circle(double u, double *cosine, double *sine)
{
    const double y = 1.5707963267948966 * (u - 0.5), q = y * y;
    double s = -1.0 / 1307674368000.0;
    s = s * q + 1.0 / 6227020800.0;
    s = s * q - 1.0 / 39916800.0;
    s = s * q + 1.0 / 362880.0;
    s = s * q - 1.0 / 5040.0;
    s = s * q + 1.0 / 120.0;
    s = s * q - 1.0 / 6.0;
    s = s * q * y + y;
    double c = 1.0 / 20922789888000.0;
    c = c * q - 1.0 / 87178291200.0;
    c = c * q + 1.0 / 479001600.0;
    c = c * q - 1.0 / 3628800.0;
    c = c * q + 1.0 / 40320.0;
    c = c * q - 1.0 / 720.0;
    c = c * q + 1.0 / 24.0;
    c = c * q - 1.0 / 2.0;
    c = c * q + 1.0;
    const double s2 = 2.0 * s * c, c2 = 1.0 - 2.0 * s * s;
    *sine = -2.0 * s2 * c2;
    *cosine = 2.0 * s2 * s2 - 1.0;
}

/* Put the sum of the weights and the sum of their squares into sums[0] and sums[1]. */
void ggx_albedo(double alpha, double sin_o, double cos_o, int64_t samples, uint64_t seed, double *sums)
{
    const double length = 1.0 / sqrt(alpha * alpha * sin_o * sin_o + cos_o * cos_o);
    const double x = alpha * sin_o * length, z = cos_o * length;
    const double root_o = sqrt(alpha * alpha * sin_o * sin_o + cos_o * cos_o);
    const uint64_t start = scramble(seed ^ UINT64_C(0x9e3779b97f4a7c15));
    double sum = 0.0, squares = 0.0;
#pragma omp parallel for simd reduction(+ : sum, squares) schedule(static)
    for (int64_t i = 0; i < samples; ++i) {
        const uint64_t place = start + UINT64_C(0x9e3779b97f4a7c15) * (uint64_t)(2 * i);
        const double u = unit(scramble(place));
        double cosine, sine;
        circle(unit(scramble(place + UINT64_C(0x9e3779b97f4a7c15))), &cosine, &sine);
        /* the visible normal, not normalised */
        const double down = u * (1.0 + z), up = (1.0 - u) * (1.0 + z);
        const double radius = sqrt(down * (up + x * x / (1.0 + z)));
        const double nx = alpha * (radius * cosine + x), ny = alpha * radius * sine, nz = up;
        const double scale = 2.0 * (sin_o * nx + cos_o * nz) / (nx * nx + ny * ny + nz * nz);
        const double wx = scale * nx - sin_o, wy = scale * ny, wz = scale * nz - cos_o;
        /* G2/G1 with the cosines multiplied out */
        const double root_i = sqrt(alpha * alpha * (wx * wx + wy * wy) + wz * wz);
        const double share = wz * (cos_o + root_o) / (wz * root_o + cos_o * root_i);
        const double weight = wz > 0.0 ? share : 0.0;
        sum += weight;
        squares += weight * weight;
    }
    sums[0] = sum;
    sums[1] = squares;
}
