/* Solar array and battery, after AtlantikSolar's published figures (Oettershagen et al. 2017):
 *   P_solar = A eta (1 - k (T - 298.15 K)) eta_chain (I_direct eps(angle) + I_diffuse 0.82707),
 *   dE/dt = eta_charge P or P / eta_discharge, charging limited towards the end. */
#include <math.h>

#include "model.h"

#define DIFFUSE 0.82707         /* mean reflection loss of diffuse light */
#define FULL_CHARGE_UNTIL 0.9   /* state of charge from which the charger tapers */
#define CHARGE_RATE 0.5         /* of the capacity per hour, up to there */
#define FINAL_CHARGE_RATE 0.046 /* at a full battery */
#define N_ANGLES 11

/* What passes the cells' surface, by the cosine of the angle of incidence (0, 15, 30, 45, 60, 70, 75, 80, 84, 87
 * and 90 deg), times that cosine: the beam on the cells. Linear in between. */
static double beam_through(double cosine) {
    static const double COSINES[N_ANGLES] = {0.0, 0.05233595624294384, 0.10452846326765346, 0.17364817766693041,
        0.25881904510252074, 0.3420201433256688, 0.5, 0.7071067811865476, 0.8660254037844387, 0.9659258262890683, 1.0};
    static const double PASSED[N_ANGLES] = {0.0, 0.34, 0.46, 0.56, 0.65, 0.76, 0.915, 0.97, 0.988, 0.997, 1.0};
    if (!(cosine > 0.0)) return 0.0;
    if (cosine >= 1.0) return 1.0;
    int i = 1;
    while (COSINES[i] < cosine) i++;
    double part = (cosine - COSINES[i - 1]) / (COSINES[i] - COSINES[i - 1]);
    return cosine * (PASSED[i - 1] + part * (PASSED[i] - PASSED[i - 1]));
}

static double solar_power(const Model *m, double sunlight) {
    const Variables *v = &m->v;
    const Sun *sun = &m->sun;
    if (sun->direct <= 0.0 || v->aircraft_solar_area <= 0.0) return 0.0;
    double warm = 1.0 - v->aircraft_solar_temperature_coefficient * (m->air.temperature - 298.15);
    double light = sun->direct * beam_through(sunlight) + sun->diffuse * DIFFUSE;
    return v->aircraft_solar_area * v->aircraft_solar_efficiency * v->aircraft_solar_chain_efficiency * warm * light;
}

/* Electric power [W] for a shaft that gives thrust times airspeed, and what goes into the cells. */
Power power_balance(const Model *m, double energy, double shaft_power, double sunlight) {
    const Variables *v = &m->v;
    double capacity = v->aircraft_battery_capacity;
    Power power = {.solar = solar_power(m, sunlight)};
    double drawn = shaft_power > 0.0 ? shaft_power / v->aircraft_power_chain_efficiency : 0.0;
    power.consumed = drawn + v->aircraft_power_avionics;
    double surplus = power.solar - power.consumed;
    if (capacity <= 0.0) return power;
    if (surplus <= 0.0) {
        power.stored = energy > 0.0 ? surplus / v->aircraft_battery_discharge_efficiency : 0.0;
        return power;
    }
    double taper = clamp((energy / capacity - FULL_CHARGE_UNTIL) / (1.0 - FULL_CHARGE_UNTIL), 0.0, 1.0);
    double most = (CHARGE_RATE + taper * (FINAL_CHARGE_RATE - CHARGE_RATE)) * capacity / 3600.0;
    if (surplus > most) surplus = most;
    power.stored = energy < capacity ? surplus * v->aircraft_battery_charge_efficiency : 0.0;
    return power;
}

/* Charge changes slowly: its rate is held between balances (100 ms, on the model's own grid). */
void battery_advance(Model *m, const Power *power, double h) {
    m->x[X_ENERGY] = clamp(m->x[X_ENERGY] + h * power->stored, 0.0, m->v.aircraft_battery_capacity);
}
