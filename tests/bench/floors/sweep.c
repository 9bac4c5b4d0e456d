/* 8 rigs at once in the lanes of a SIMD register: equations 6-7 at a steady torque, both sides sliding forward, one
   fourth-order step a tick; Eq. 8 by the recurrence, sin and cos from the vector library. Compile with -ffast-math
   -fopenmp. Rig r has K[r], J_l[r], tau_c[r]; y is (4, rigs). */
#include <math.h>

enum { L = 8 };
typedef struct {
    double ratio, J_m, B_m, B_l, B_ml, B_sp, sigma, tau_s, omega_s, F_cl;
    long terms;
    double a[64], b[64];
} Common;

static inline void rates(const Common *g, const double *K, const double *J_l, const double *tau_c, double tau,
                         double y[4][L], double d[4][L]) {
    double c[L], s[L], c0[L], s0[L], twice[L], value[L], slope[L];
    /* apart: together the compiler makes one scalar call of the two */
#pragma omp simd
    for (int i = 0; i < L; i++) c[i] = cos(y[0][i]);
#pragma omp simd
    for (int i = 0; i < L; i++) s[i] = sin(y[0][i]);
#pragma omp simd
    for (int i = 0; i < L; i++) {
        twice[i] = 2.0 * c[i];
        c0[i] = 1.0;
        s0[i] = value[i] = slope[i] = 0.0;
    }
    for (long n = 0; n < g->terms; n++) {
        const double a = g->a[n], b = g->b[n], m = (double)(n + 1);
#pragma omp simd
        for (int i = 0; i < L; i++) {
            value[i] += a * c[i] + b * s[i];
            slope[i] += m * (b * c[i] - a * s[i]);
            const double c1 = twice[i] * c[i] - c0[i], s1 = twice[i] * s[i] - s0[i];
            c0[i] = c[i];
            s0[i] = s[i];
            c[i] = c1;
            s[i] = s1;
        }
    }
#pragma omp simd
    for (int i = 0; i < L; i++) {
        const double lever = slope[i] - 1.0 / g->ratio, phi = y[2][i] - y[0][i] / g->ratio + value[i];
        const double S = K[i] * phi + g->B_sp * (y[3][i] + lever * y[1][i]), M = g->B_ml * (y[1][i] + g->sigma * y[3][i]);
        const double x = y[1][i] / g->omega_s, grip = tau_c[i] + (g->tau_s - tau_c[i]) * exp(-x * x);
        d[0][i] = y[1][i];
        d[1][i] = (tau - S * lever - M - g->B_m * y[1][i] - grip) / g->J_m;
        d[2][i] = y[3][i];
        d[3][i] = (-S - g->sigma * M - g->B_l * y[3][i] - g->F_cl) / J_l[i];
    }
}

static inline void along(double y[4][L], double d[4][L], double h, double z[4][L]) {
    for (int j = 0; j < 4; j++)
#pragma omp simd
        for (int i = 0; i < L; i++) z[j][i] = y[j][i] + h * d[j][i];
}

void sweep(const Common *g, long rigs, const double *K, const double *J_l, const double *tau_c, double tau, long ticks,
           double h, double *state) {
#pragma omp parallel for
    for (long r = 0; r < rigs; r += L) {
        double y[4][L], z[4][L], k1[4][L], k2[4][L], k3[4][L], k4[4][L];
        for (int j = 0; j < 4; j++)
            for (int i = 0; i < L; i++) y[j][i] = state[j * rigs + r + i];
        for (long k = 0; k < ticks; k++) {
            rates(g, K + r, J_l + r, tau_c + r, tau, y, k1);
            along(y, k1, 0.5 * h, z);
            rates(g, K + r, J_l + r, tau_c + r, tau, z, k2);
            along(y, k2, 0.5 * h, z);
            rates(g, K + r, J_l + r, tau_c + r, tau, z, k3);
            along(y, k3, h, z);
            rates(g, K + r, J_l + r, tau_c + r, tau, z, k4);
            for (int j = 0; j < 4; j++)
#pragma omp simd
                for (int i = 0; i < L; i++) y[j][i] += h / 6.0 * (k1[j][i] + 2.0 * (k2[j][i] + k3[j][i]) + k4[j][i]);
        }
        for (int j = 0; j < 4; j++)
            for (int i = 0; i < L; i++) state[j * rigs + r + i] = y[j][i];
    }
}
