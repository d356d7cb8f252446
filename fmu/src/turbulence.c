/* Dryden turbulence of MIL-F-8785C (3.7.2.1) at low altitude: three translational gusts in the axes of the mean
 * motion through the air, from a seeded noise, sampled on the model's own grid and held in between.
 * Each forming filter is discretised exactly (state transition and stationary covariance), so that the intensity
 * does not depend on the sampling period. */
#include <math.h>
#include <string.h>

#include "model.h"

#define FOOT 0.3048
#define LOWEST 10.0   /* the model's range of altitude above ground [ft]; held beyond */
#define HIGHEST 1000.0

/* splitmix64 (Steele, Lea & Flood 2014). */
static uint64_t next_random(uint64_t *state) {
    uint64_t z = (*state += UINT64_C(0x9E3779B97F4A7C15));
    z = (z ^ (z >> 30)) * UINT64_C(0xBF58476D1CE4E5B9);
    z = (z ^ (z >> 27)) * UINT64_C(0x94D049BB133111EB);
    return z ^ (z >> 31);
}

static double uniform(uint64_t *state) { return ((double)(next_random(state) >> 11) + 0.5) / 9007199254740992.0; }

/* Two normal deviates (Box & Muller 1958). */
static void normal_pair(uint64_t *state, double pair[2]) {
    double radius = sqrt(-2.0 * log(uniform(state))), angle = 2.0 * PI * uniform(state);
    pair[0] = radius * cos(angle);
    pair[1] = radius * sin(angle);
}

/* Calm at the start; the gusts grow to their intensity within a few scale lengths. */
void turbulence_reset(Model *m) {
    memset(&m->turbulence, 0, sizeof m->turbulence);
    m->turbulence.random = (uint64_t)(int64_t)m->v.turbulence_seed;
}

/* Transverse gust, (1 + sqrt(3) t s)/(1 + t s)^2 with t = L/V: two cascaded lags x1, x2 in units in which
 * the stationary covariance is [[2, 1], [1, 1]] and the gust sigma/2 (sqrt(3) x1 + (1 - sqrt(3)) x2). */
static double transverse(double x[2], double ratio, double sigma, const double noise[2]) {
    double decay = exp(-ratio), cross = ratio * decay;
    double q11 = 2.0 * (1.0 - decay * decay);
    double q12 = 1.0 - decay * (2.0 * cross + decay);
    double q22 = 1.0 - (2.0 * cross * cross + 2.0 * cross * decay + decay * decay);
    double l11 = sqrt(q11), l21 = q12 / l11, rest = q22 - l21 * l21, l22 = rest > 0.0 ? sqrt(rest) : 0.0;
    double first = decay * x[0] + l11 * noise[0];
    x[1] = cross * x[0] + decay * x[1] + l21 * noise[0] + l22 * noise[1];
    x[0] = first;
    return 0.5 * sigma * (1.7320508075688772 * x[0] - 0.7320508075688772 * x[1]);
}

void turbulence_sample(Model *m, const Motion *o, double period) {
    const Variables *v = &m->v;
    Turbulence *t = &m->turbulence;
    double height = clamp((o->altitude - v->ground_elevation) / FOOT, LOWEST, HIGHEST);
    double spread = 0.177 + 0.000823 * height;
    double length_w = height * FOOT, length_u = height / pow(spread, 1.2) * FOOT;
    double sigma_w = 0.1 * v->turbulence_wind_speed, sigma_u = sigma_w / pow(spread, 0.4);
    double travelled = period * (o->airspeed > 1.0 ? o->airspeed : 1.0);
    double a[2], b[2], c[2];
    normal_pair(&t->random, a);
    normal_pair(&t->random, b);
    normal_pair(&t->random, c);
    double decay = exp(-travelled / length_u);
    t->along = decay * t->along + sqrt(1.0 - decay * decay) * a[0];
    double along = sigma_u * t->along;
    double side = transverse(t->side, travelled / length_u, sigma_u, b);
    double down = transverse(t->vertical, travelled / length_w, sigma_w, c);
    double north = o->velocity_north - v->wind_north;
    double east = o->velocity_east - v->wind_east;
    double level = sqrt(north * north + east * east);
    double cn = level > 0.1 ? north / level : 1.0, ce = level > 0.1 ? east / level : 0.0;
    t->gust[0] = along * cn - side * ce;
    t->gust[1] = along * ce + side * cn;
    t->gust[2] = down;
}
