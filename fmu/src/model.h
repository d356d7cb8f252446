/* The aircraft: what the parts of the model share.
 *
 * SI units and radians. Map axes: north, east, altitude above home. Body axes: forward, right, down.
 * One Model is one instance; it is plain data without pointers, so it can be copied as it is.
 */
#ifndef SIDESTEP_MODEL_H
#define SIDESTEP_MODEL_H

#include <stdbool.h>
#include <stdint.h>

#include "angles.h"
#include "variables.h"

#if defined(__GNUC__)
#pragma GCC visibility push(hidden) /* only the functions of FMI leave the library */
#endif

#if defined(__clang__)
#pragma STDC FP_CONTRACT OFF /* the same bits from every compiler; gcc needs -ffp-contract=off */
#endif

#define PI 3.14159265358979323846

/* Period of the guidance [ns]: 10 ms as the paper has it (Eq. 20), 100 ms for the kinematic fidelity. */
#define GUIDANCE_PERIOD_6DOF INT64_C(10000000)
#define GUIDANCE_PERIOD_KINEMATIC INT64_C(100000000)

/* Period over which the battery's power is held [ns]. */
#define POWER_PERIOD INT64_C(100000000)

enum { MODE_DIRECT, MODE_LEG, MODE_ORBIT };
enum { LAW_PAPER, LAW_L1 };
enum { FIDELITY_6DOF, FIDELITY_KINEMATIC };
enum { PROPULSION_DISC, PROPULSION_LINEAR };
enum { LAUNCH_NONE, LAUNCH_CATAPULT, LAUNCH_RUNWAY };

/* Where a flight is: waiting for its launch, on the catapult or runway, in the air, down again. */
enum { FLIGHT_HELD, FLIGHT_LAUNCHED, FLIGHT_FLYING, FLIGHT_LANDED };

/* What can happen between samples, as bits. */
enum {
    EVENT_RELEASED = 1, EVENT_AIRBORNE = 2, EVENT_CLEAR = 4, EVENT_CONTACT = 8, EVENT_EMPTY = 16, EVENT_RESERVE = 32
};

/* State of the 6-DOF airframe. Velocity is over ground, quaternion rotates body into north-east-down. */
enum {
    X_NORTH, X_EAST, X_ALTITUDE,
    X_U, X_V, X_W,
    X_Q0, X_Q1, X_Q2, X_Q3,
    X_P, X_Q, X_R,
    X_AILERON, X_ELEVATOR, X_RUDDER, X_THROTTLE,
    N_MECHANICAL,
    X_ENERGY = N_MECHANICAL, /* in the battery [J] */
    N_STATES
};

/* State of the kinematic fidelity. Heading is that of the velocity through the air. */
enum { K_NORTH, K_EAST, K_ALTITUDE, K_AIRSPEED, K_HEADING, K_BANK, K_CLIMB, N_KINEMATIC };

/* What the guidance and the autopilot know of the motion. */
typedef struct {
    double north, east, altitude;
    double velocity_north, velocity_east, climb;
    double airspeed, alpha, beta;
    double bank, pitch, heading;
    double sin_bank, cos_bank;
    double p, q, r;
} Motion;

/* What the air and the engine do to the airframe. */
typedef struct {
    double force[3];   /* body, without weight [N] */
    double moment[3];  /* body [N m] */
    double airspeed, alpha, beta, thrust;
    double sunlight;   /* cosine of the angle between the sun and the body's upward axis */
    bool stalled;
} Loads;

/* The air at one altitude. */
typedef struct {
    double density, pressure, temperature; /* [kg/m3], [Pa], [K] */
    double slope;                          /* change of density with altitude [kg/m4] */
} Air;

/* Where electric power comes from and goes to [W]. */
typedef struct {
    double solar, consumed, stored;
} Power;

/* The sun as seen from home: unit vector to it in north-east-down, irradiance [W/m2]. */
typedef struct {
    double direction[3];
    double direct, diffuse;
    double elevation, azimuth;
} Sun;

/* Dryden filters: states of the forming filters, and the noise that drives them. */
typedef struct {
    double along, side[2], vertical[2];
    double gust[3];            /* north, east, down [m/s], held between samples */
    uint64_t random;
} Turbulence;

/* Level flight at one airspeed. */
typedef struct {
    double alpha, elevator, throttle, thrust;
} Trim;

/* Constants of the equations of moments (Stevens & Lewis 1.7: symmetric about the x-z plane). */
typedef struct {
    double c1, c2, c3, c4, c5, c6, c7, c8, c9;
} InertiaConstants;

/* What the guidance asks for. */
typedef struct {
    double bank, climb, airspeed;
} Demand;

typedef struct {
    double leg[4];             /* leg the memory belongs to: from north, east, to north, east */
    double origin_north, origin_east;  /* where the line begins */
    double line_north, line_east;      /* unit vector along it */
    int mode;                  /* mode the memory belongs to */
    bool leg_known;
    bool cross_track_known;
    double cross_track_old;    /* DD_old of Eq. 20 [m] */
    double bank_command_deg;   /* roll command of Eq. 19 [deg] */
    double turn_sign;          /* side chosen for a reversal of course, 0 if none */
    double climb_command;      /* slewed climb command [m/s] */
    double cross_track;        /* for the output [m] */
} GuidanceMemory;

typedef struct {
    double alpha, sin_alpha;   /* angle of attack that the demand needs [rad], and its sine */
    double thrust;             /* thrust that the demand needs [N] */
    double roll, climb, sideslip, airspeed;  /* integrals */
} AutopilotMemory;

typedef struct {
    Variables v;
    InertiaConstants inertia;
    double per_mass, per_surface_time, per_throttle_time; /* inverses: a division costs more than a product */
    Trim trim;
    double x[N_STATES];        /* state of either fidelity, and the battery's */
    double actuator[4];        /* commands to aileron, elevator, rudder, throttle */
    Air air;                   /* at the last sample of the atmosphere */
    double air_altitude;       /* where that was [m above home] */
    double gravity;            /* at the last sample [m/s2] */
    Turbulence turbulence;
    Sun sun;
    Power power;
    Demand demand;
    GuidanceMemory guidance;
    AutopilotMemory autopilot;
    double start_time;         /* [s] */
    double contact_speed;      /* sink rate at contact [m/s] */
    int64_t now;               /* time since the start [ns]: does not drift */
    int64_t next_sample;       /* next call of the guidance [ns] */
    int64_t next_sun;          /* next position of the sun [ns] */
    int64_t next_power;        /* next balance of electric power [ns] */
    int flight;                /* FLIGHT_... */
    int events;                /* EVENT_... that have happened and not been told */
    bool clear_of_ground;      /* has been high enough for a contact to count */
    bool empty;                /* the battery has been emptied; the motor stays off */
    bool on_reserve;
    bool continuous;           /* an importer integrates the state (Model Exchange) */
    bool outputs_stale;
} Model;

/* atmosphere.c */
Air air_at(double altitude);
void atmosphere_sample(Model *m);

/* turbulence.c */
void turbulence_reset(Model *m);
void turbulence_sample(Model *m, const Motion *motion, double period);

/* powertrain.c */
double throttle_for(const Variables *v, double thrust_wanted, double airspeed, double density);

/* sun.c, battery.c */
void sun_sample(Model *m);
Power power_balance(const Model *m, double energy, double shaft_power, double sunlight);
void battery_advance(Model *m, const Power *power, double h);

/* airframe.c */
void inertia_constants(const Variables *v, InertiaConstants *constants);
bool inertia_is_real(const Variables *v);
double gravity_at(const Variables *v, double altitude);
double lift_coefficient(const Variables *v, double alpha, double *slope);
double drag_coefficient(const Variables *v, double alpha, double beta, double elevator);
void airframe_derivative(const Model *m, const double x[], double dx[], Loads *loads);
void airframe_advance(Model *m, double h);
void airframe_motion(const Model *m, Motion *motion);
void airframe_angles(const Model *m, Motion *motion);

/* start.c */
void quaternion_from_euler(double bank, double pitch, double heading, double q[4]);

/* kinematic.c */
void kinematic_advance(Model *m, double h);
void kinematic_motion(const Model *m, Motion *motion);

/* ground.c: before an event its indicator is positive */
enum { INDICATOR_GROUND, INDICATOR_LAUNCH, INDICATOR_BATTERY, N_INDICATORS };
void ground_motion(const Model *m, const double x[], const double R[9], Loads *loads, double dx[]);
void ground_rest(Model *m);
void model_indicators(const Model *m, double indicators[N_INDICATORS]);
bool event_due(const Model *m);
bool model_events(Model *m);

/* trim.c */
bool trim_level(const Variables *v, double airspeed, double density, double gravity, Trim *trim);

/* guidance.c */
void guidance_forget(Model *m);
void guidance_sample(Model *m, const Motion *motion, double period);

/* autopilot.c */
void autopilot_reset(Model *m);
void autopilot_sample(Model *m, const Motion *motion, double period);

/* start.c, advance.c, outputs.c: NULL or a message that says what is wrong */
void model_defaults(Model *m);
const char *model_initialise(Model *m, double start_time);
void model_inputs(Model *m);
void model_surfaces(Model *m);
const char *model_command_problem(const Model *m);
void model_sample(Model *m);
int64_t model_next_event(const Model *m);
const char *model_advance(Model *m, int64_t until, bool stop_at_events);
void model_motion(const Model *m, Motion *motion);
void model_derivative(Model *m, double dx[N_STATES]);
void model_outputs(Model *m);

static inline bool is_kinematic(const Model *m) { return m->v.fidelity == FIDELITY_KINEMATIC; }

static inline double clamp(double value, double low, double high) {
    return value < low ? low : value > high ? high : value;
}

/* Attitude: unit quaternion, body to north-east-down (Beard & McLain 2012, appendix B.1).
 * Rows of the matrix are north, east, down; columns the body axes. */
static inline void rotation_matrix(const double q[4], double R[9]) {
    double w = q[0], x = q[1], y = q[2], z = q[3];
    R[0] = 1.0 - 2.0 * (y * y + z * z), R[1] = 2.0 * (x * y - w * z), R[2] = 2.0 * (x * z + w * y);
    R[3] = 2.0 * (x * y + w * z), R[4] = 1.0 - 2.0 * (x * x + z * z), R[5] = 2.0 * (y * z - w * x);
    R[6] = 2.0 * (x * z - w * y), R[7] = 2.0 * (y * z + w * x), R[8] = 1.0 - 2.0 * (x * x + y * y);
}

static inline void rotate(const double R[9], const double b[3], double ned[3]) {
    for (int i = 0; i < 3; i++) ned[i] = R[3 * i] * b[0] + R[3 * i + 1] * b[1] + R[3 * i + 2] * b[2];
}

static inline void rotate_back(const double R[9], const double n[3], double b[3]) {
    for (int i = 0; i < 3; i++) b[i] = R[i] * n[0] + R[3 + i] * n[1] + R[6 + i] * n[2];
}

/* Density near the last sample: linear in altitude (a pow() in every derivative would cost a tenth of the step). */
static inline double density_at(const Model *m, double altitude) {
    if (RARELY(m->continuous)) return air_at(m->v.environment_home_elevation + altitude).density;
    double density = m->air.density + m->air.slope * (altitude - m->air_altitude);
    return density > 0.0 ? density : 0.0;
}

/* Thrust [N] along the body's forward axis for a throttle (0 to 1).
 * Disc: T = 1/2 rho S C Vd (Vd - Va), Vd = Va + throttle (k - Va) (Fitzpatrick 2013, Eqs. 4-6).
 * Linear: T = throttle * Tmax. */
static inline double thrust(const Variables *v, double throttle, double airspeed, double density) {
    if (v->aircraft_propulsion_model == PROPULSION_LINEAR) return throttle * v->aircraft_propulsion_max_thrust;
    double added = throttle * (v->aircraft_propulsion_motor_speed - airspeed);
    double disc = v->aircraft_propulsion_disc_area * v->aircraft_propulsion_coefficient;
    return 0.5 * density * disc * (airspeed + added) * added;
}

static inline double wrap(double angle) {  /* into -pi .. pi, for angles within a few turns */
    while (angle > PI) angle -= 2.0 * PI;
    while (angle < -PI) angle += 2.0 * PI;
    return angle;
}

#if defined(__GNUC__)
#pragma GCC visibility pop
#endif

#endif
