/* Level flight in still air: angle of attack, elevator and throttle for which nothing accelerates. */
#include <math.h>

#include "model.h"

/* Weight that is not carried [N]: lift plus the thrust's share, thrust being what balances drag. */
static double residual(const Variables *v, double alpha, double pressure_area, double weight, Trim *t) {
    t->alpha = alpha;
    t->elevator = -(v->aircraft_aero_Cm0 + v->aircraft_aero_Cm_alpha * alpha) / v->aircraft_aero_Cm_elevator;
    double lift = lift_coefficient(v, alpha, 0) + v->aircraft_aero_CL_elevator * t->elevator;
    double drag = drag_coefficient(v, alpha, 0.0, t->elevator);
    t->thrust = pressure_area * drag / cos(alpha);
    return pressure_area * lift + t->thrust * sin(alpha) - weight;
}

/* Newton's method on the angle of attack. False if there is no such flight within the aircraft's limits. */
bool trim_level(const Variables *v, double airspeed, double density, double gravity, Trim *trim) {
    if (airspeed <= 0.0 || v->aircraft_aero_Cm_elevator == 0.0) return false;
    double pressure_area = 0.5 * density * airspeed * airspeed * v->aircraft_wing_area;
    double alpha = 0.02, step = 1e-6, weight = v->aircraft_mass * gravity;
    bool found = false;
    for (int i = 0; i < 50 && !found; i++) {
        double r = residual(v, alpha, pressure_area, weight, trim);
        double slope = (residual(v, alpha + step, pressure_area, weight, trim)
                        - residual(v, alpha - step, pressure_area, weight, trim)) / (2.0 * step);
        if (slope == 0.0) return false;
        double change = clamp(-r / slope, -0.05, 0.05);
        alpha = clamp(alpha + change, v->aircraft_aero_alpha_min, v->aircraft_aero_alpha_max);
        found = fabs(change) < 1e-14;
    }
    double left = residual(v, alpha, pressure_area, weight, trim);
    trim->throttle = throttle_for(v, trim->thrust, airspeed, density);
    double missing = trim->thrust - thrust(v, trim->throttle, airspeed, density);
    return fabs(left) < 1e-8 * weight && fabs(missing) < 1e-8 * weight
        && fabs(trim->elevator) <= v->aircraft_actuator_elevator_limit;
}
