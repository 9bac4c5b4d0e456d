/* Equations 6-7 with Stribeck friction, Coulomb friction of the load and a first-order drive: classical fourth-order
   Runge-Kutta, `sub` steps a tick, under a PID on the motor at each tick. -DTABLE takes Eq. 8 from a cubic table of
   4096 cells, else from the recurrence of cos and sin. A side that comes to rest is held there from the step's end. */
#include <math.h>
#include <stdlib.h>

enum { CELLS = 4096, TERMS = 64 };
static double table[CELLS + 1][2];

typedef struct {
    double ratio, J_m, J_l, K, B_m, B_l, B_ml, B_sp, sigma, tau_c, tau_s, omega_s, F_cl, T_drive;
    double Kp, Ki, Kd, ff, limit;
    long terms;
    double a[TERMS], b[TERMS];
} Rig;

static inline void series(const Rig *r, double theta, double *value, double *slope) {
    double c = cos(theta), s = sin(theta), twice = 2.0 * c, c0 = 1.0, s0 = 0.0, v = 0.0, d = 0.0;
    for (long n = 0; n < r->terms; n++) {
        v += r->a[n] * c + r->b[n] * s;
        d += (double)(n + 1) * (r->b[n] * c - r->a[n] * s);
        double c1 = twice * c - c0, s1 = twice * s - s0;
        c0 = c; s0 = s; c = c1; s = s1;
    }
    *value = v; *slope = d;
}

void tabulate(const Rig *r) {
    for (int i = 0; i <= CELLS; i++) series(r, 2.0 * M_PI * i / CELLS, &table[i][0], &table[i][1]);
}

static inline void error_at(const Rig *r, double theta, double *value, double *slope) {
#ifdef TABLE
    const double h = 2.0 * M_PI / CELLS, x = theta * (1.0 / h), whole = floor(x), u = x - whole;
    const int i = (int)((long)whole & (CELLS - 1));
    const double f0 = table[i][0], f1 = table[i + 1][0], d0 = h * table[i][1], d1 = h * table[i + 1][1];
    const double c2 = 3.0 * (f1 - f0) - 2.0 * d0 - d1, c3 = 2.0 * (f0 - f1) + d0 + d1;
    *value = f0 + u * (d0 + u * (c2 + u * c3));
    *slope = (d0 + u * (2.0 * c2 + 3.0 * u * c3)) * (1.0 / h);
#else
    series(r, theta, value, slope);
#endif
}

static inline void torques(const Rig *r, const double *y, double tau, double *m, double *l) {
    double value, slope;
    error_at(r, y[0], &value, &slope);
    const double lever = slope - 1.0 / r->ratio, phi = y[2] - y[0] / r->ratio + value;
    const double S = r->K * phi + r->B_sp * (y[3] + lever * y[1]), M = r->B_ml * (y[1] + r->sigma * y[3]);
    *m = tau - S * lever - M - r->B_m * y[1];
    *l = -S - r->sigma * M - r->B_l * y[3];
}

static inline void rates(const Rig *r, const double *y, double tau, double side_m, double side_l, double *d) {
    double m, l;
    torques(r, y, tau, &m, &l);
    const double x = y[1] / r->omega_s;
    d[0] = y[1]; d[2] = y[3];
    d[1] = side_m != 0.0 ? (m - side_m * (r->tau_c + (r->tau_s - r->tau_c) * exp(-x * x))) / r->J_m : 0.0;
    d[3] = side_l != 0.0 ? (l - side_l * r->F_cl) / r->J_l : 0.0;
}

static inline double way(double omega, double net, double hold) {
    if (omega != 0.0) return copysign(1.0, omega);
    return fabs(net) <= hold ? 0.0 : copysign(1.0, net);
}

static void step(const Rig *r, double *y, double tau, double lag, double h, double half) {
    double m, l, k1[4], k2[4], k3[4], k4[4], z[4];
    torques(r, y, tau + lag, &m, &l);
    const double side_m = way(y[1], m, r->tau_s), side_l = way(y[3], l, r->F_cl);
    rates(r, y, tau + lag, side_m, side_l, k1);
    for (int i = 0; i < 4; i++) z[i] = y[i] + 0.5 * h * k1[i];
    rates(r, z, tau + lag * half, side_m, side_l, k2);
    for (int i = 0; i < 4; i++) z[i] = y[i] + 0.5 * h * k2[i];
    rates(r, z, tau + lag * half, side_m, side_l, k3);
    for (int i = 0; i < 4; i++) z[i] = y[i] + h * k3[i];
    rates(r, z, tau + lag * half * half, side_m, side_l, k4);
    for (int i = 0; i < 4; i++) y[i] += h / 6.0 * (k1[i] + 2.0 * (k2[i] + k3[i]) + k4[i]);
    if (side_m * y[1] < 0.0) y[1] = 0.0;
    if (side_l * y[3] < 0.0) y[3] = 0.0;
}

/* `n` ticks of `dt` s from `y`; the reference is theta_ref[n] [rad], its speed omega_ref[n]; error[n] = θ_m/N − θ_l. */
void run(const Rig *r, long n, double dt, long sub, const double *theta_ref, const double *omega_ref, double *y,
         double *error) {
    double integral = 0.0, applied = 0.0;
    const double h = dt / (double)sub, half = exp(-0.5 * h / r->T_drive);
    for (long k = 0; k < n; k++) {
        const double e = theta_ref[k] - y[0];
        integral += r->Ki * e * dt;
        double tau = r->Kp * e + integral + r->Kd * (omega_ref[k] - y[1]) + r->ff * omega_ref[k];
        tau = fmin(fmax(tau, -r->limit), r->limit);
        double lag = applied - tau;
        for (long i = 0; i < sub; i++) {
            step(r, y, tau, lag, h, half);
            lag *= half * half;
        }
        applied = tau + lag;
        error[k] = y[0] / r->ratio - y[2];
    }
}
