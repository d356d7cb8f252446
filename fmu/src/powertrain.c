/* Propeller: from the thrust wanted back to the throttle (thrust itself is in model.h). */
#include <math.h>

#include "model.h"

/* Throttle that gives a thrust, within 0..1. */
double throttle_for(const Variables *v, double thrust_wanted, double airspeed, double density) {
    if (thrust_wanted <= 0.0) return 0.0;
    if (v->aircraft_propulsion_model == PROPULSION_LINEAR) {
        double most = v->aircraft_propulsion_max_thrust;
        return most > thrust_wanted ? thrust_wanted / most : 1.0;
    }
    double disc = v->aircraft_propulsion_disc_area * v->aircraft_propulsion_coefficient;
    double room = v->aircraft_propulsion_motor_speed - airspeed;
    if (disc <= 0.0 || room <= 0.0) return 1.0;
    double per_room = 1.0 / room, added = 8.0 / (density * disc); /* neither waits for the thrust */
    double slipstream = 0.5 * (airspeed + sqrt(airspeed * airspeed + added * thrust_wanted));
    return clamp((slipstream - airspeed) * per_room, 0.0, 1.0);
}
