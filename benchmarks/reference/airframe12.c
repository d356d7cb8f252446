/* The yardstick: the Skywalker X8 as the textbooks write it down, twelve states, nothing else.
 *
 * Beard & McLain 2012, ch. 3 and 4: position, body velocity, Euler angles, body rates; the aerodynamic polynomial
 * and the propeller of fmu/aircraft/skywalker_x8.toml as constants; surfaces, throttle, gravity and density held;
 * still air; Runge-Kutta of order four. No guidance, no actuators, no wind, no outputs, no checks. */
#include <math.h>

enum { NORTH, EAST, DOWN, U, V, W, PHI, THETA, PSI, P, Q, R, N };

static const double MASS = 3.364, JX = 0.335, JY = 0.14, JZ = 0.4, JXZ = -0.029;
static const double S = 0.75, B = 2.1, C = 0.35714285714285715, RHO = 1.225, G = 9.81;

static void derivative(const double x[N], const double control[4], double dx[N]) {
    double u = x[U], v = x[V], w = x[W], p = x[P], q = x[Q], r = x[R];
    double sf = sin(x[PHI]), cf = cos(x[PHI]), st = sin(x[THETA]), ct = cos(x[THETA]);
    double ss = sin(x[PSI]), cs = cos(x[PSI]);
    double da = control[0], de = control[1], throttle = control[3];

    double airspeed = sqrt(u * u + v * v + w * w);
    double a = atan2(w, u), b = asin(v / airspeed), sa = sin(a), ca = cos(a);
    double pb = p * B / (2 * airspeed), qc = q * C / (2 * airspeed), rb = r * B / (2 * airspeed);
    double CL = 0.08673556671610734 + 4.020328244000679 * a + 3.87 * qc + 0.2780736201734713 * de;
    double CD = 0.01970001181915082 + 0.07909146315766297 * a + 1.0554699867680841 * a * a
        + 0.06334739678180232 * de * de + 0.14781193079241584 * b * b;
    double CY = -0.22387215700254048 * b - 0.13735505263157893 * pb + 0.08386876842105263 * rb
        + 0.043276402502774876 * da;
    double Cl = -0.08489628639662417 * b - 0.404198 * pb + 0.0555206 * rb + 0.12018814125782745 * da;
    double Cm = 0.018 - 0.2524 * a - 1.3012370370370372 * qc - 0.2292 * de;
    double Cn = 0.0283 * b + 0.004365511578947368 * pb - 0.072 * rb - 0.00339 * da;
    double qS = 0.5 * RHO * airspeed * airspeed * S;
    double exit_speed = airspeed + throttle * (37.42 - airspeed);
    double thrust = 0.5 * RHO * 0.10178760197630929 * 0.248 * exit_speed * (exit_speed - airspeed);
    double fx = thrust + qS * (CL * sa - CD * ca), fy = qS * CY, fz = qS * (-CL * ca - CD * sa);
    double l = qS * B * Cl, m = qS * C * Cm, n = qS * B * Cn;

    dx[NORTH] = ct * cs * u + (sf * st * cs - cf * ss) * v + (cf * st * cs + sf * ss) * w;
    dx[EAST] = ct * ss * u + (sf * st * ss + cf * cs) * v + (cf * st * ss - sf * cs) * w;
    dx[DOWN] = -st * u + sf * ct * v + cf * ct * w;
    dx[U] = r * v - q * w - G * st + fx / MASS;
    dx[V] = p * w - r * u + G * ct * sf + fy / MASS;
    dx[W] = q * u - p * v + G * ct * cf + fz / MASS;
    dx[PHI] = p + (q * sf + r * cf) * st / ct;
    dx[THETA] = q * cf - r * sf;
    dx[PSI] = (q * sf + r * cf) / ct;
    double det = JX * JZ - JXZ * JXZ;
    dx[P] = (JXZ * (JX - JY + JZ) * p * q - (JZ * (JZ - JY) + JXZ * JXZ) * q * r + JZ * l + JXZ * n) / det;
    dx[Q] = ((JZ - JX) * p * r - JXZ * (p * p - r * r) + m) / JY;
    dx[R] = (((JX - JY) * JX + JXZ * JXZ) * p * q - JXZ * (JX - JY + JZ) * q * r + JXZ * l + JX * n) / det;
}

/* Steps of order four; `x` and `control` as above. */
void airframe12(double x[N], const double control[4], double h, int steps) {
    double k[N], sum[N], at[N];
    for (int step = 0; step < steps; step++) {
        derivative(x, control, k);
        for (int i = 0; i < N; i++) { sum[i] = k[i]; at[i] = x[i] + 0.5 * h * k[i]; }
        derivative(at, control, k);
        for (int i = 0; i < N; i++) { sum[i] += 2 * k[i]; at[i] = x[i] + 0.5 * h * k[i]; }
        derivative(at, control, k);
        for (int i = 0; i < N; i++) { sum[i] += 2 * k[i]; at[i] = x[i] + h * k[i]; }
        derivative(at, control, k);
        for (int i = 0; i < N; i++) x[i] += h / 6 * (sum[i] + k[i]);
    }
}
