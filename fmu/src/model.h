/* The aircraft: what the parts of the model share.
 *
 * SI units and radians. Map axes: north, east, altitude above home. Body axes: forward, right, down.
 * One Model is one instance; it is plain data without pointers, so it can be copied as it is.
 */
#ifndef SIDESTEP_MODEL_H
#define SIDESTEP_MODEL_H

#include <stdbool.h>
#include <stdint.h>

#include "variables.h"

#define PI 3.14159265358979323846

/* Period of the guidance [ns]: 10 ms as the paper has it (Eq. 20), 100 ms for the kinematic fidelity. */
#define GUIDANCE_PERIOD_6DOF INT64_C(10000000)
#define GUIDANCE_PERIOD_KINEMATIC INT64_C(100000000)

enum { MODE_DIRECT, MODE_LEG, MODE_ORBIT };
enum { LAW_PAPER, LAW_L1 };
enum { FIDELITY_6DOF, FIDELITY_KINEMATIC };
enum { PROPULSION_DISC, PROPULSION_LINEAR };

/* State of the 6-DOF airframe. Velocity is over ground, quaternion rotates body into north-east-down. */
enum {
    X_NORTH, X_EAST, X_ALTITUDE,
    X_U, X_V, X_W,
    X_Q0, X_Q1, X_Q2, X_Q3,
    X_P, X_Q, X_R,
    X_AILERON, X_ELEVATOR, X_RUDDER, X_THROTTLE,
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
    double p, q, r;
} Motion;

/* What the air and the engine do to the airframe. */
typedef struct {
    double force[3];   /* body, without weight [N] */
    double moment[3];  /* body [N m] */
    double airspeed, alpha, beta, thrust;
    bool stalled;
} Loads;

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
    double alpha;              /* angle of attack that the demand needs [rad] */
    double thrust;             /* thrust that the demand needs [N] */
    double roll, climb, sideslip, airspeed;  /* integrals */
} AutopilotMemory;

typedef struct {
    Variables v;
    InertiaConstants inertia;
    Trim trim;
    double x[N_STATES];        /* state of either fidelity */
    double actuator[4];        /* commands to aileron, elevator, rudder, throttle */
    double density;            /* [kg/m3], held between guidance samples */
    Demand demand;
    GuidanceMemory guidance;
    AutopilotMemory autopilot;
    double start_time;         /* [s] */
    int64_t now;               /* time since the start [ns]: does not drift */
    int64_t next_sample;       /* next call of the guidance [ns] */
    bool outputs_stale;
} Model;

/* atmosphere.c */
double air_density(double altitude);

/* powertrain.c */
double thrust(const Variables *v, double throttle, double airspeed, double density);
double throttle_for(const Variables *v, double thrust_wanted, double airspeed, double density);

/* airframe.c */
void inertia_constants(const Variables *v, InertiaConstants *constants);
bool inertia_is_real(const Variables *v);
double lift_coefficient(const Variables *v, double alpha, double *slope);
double drag_coefficient(const Variables *v, double alpha, double beta, double elevator);
void airframe_derivative(const Model *m, const double x[], double dx[], Loads *loads);
void airframe_advance(Model *m, double h);
void airframe_motion(const Model *m, Motion *motion);
void quaternion_from_euler(double bank, double pitch, double heading, double q[4]);
void body_from_ground(const double q[4], const double ned[3], double body[3]);

/* kinematic.c */
void kinematic_advance(Model *m, double h);
void kinematic_motion(const Model *m, Motion *motion);

/* trim.c */
bool trim_level(const Variables *v, double airspeed, double density, Trim *trim);

/* guidance.c */
void guidance_forget(Model *m);
void guidance_sample(Model *m, const Motion *motion, double period);

/* autopilot.c */
void autopilot_reset(Model *m);
void autopilot_sample(Model *m, const Motion *motion, double period);

/* instance.c: NULL or a message that says what is wrong */
void model_defaults(Model *m);
const char *model_initialise(Model *m, double start_time);
const char *model_advance(Model *m, int64_t until);
void model_outputs(Model *m);

static inline double clamp(double value, double low, double high) {
    return value < low ? low : value > high ? high : value;
}

static inline double wrap(double angle) {  /* into -pi .. pi, for angles within a few turns */
    while (angle > PI) angle -= 2.0 * PI;
    while (angle < -PI) angle += 2.0 * PI;
    return angle;
}

#endif
