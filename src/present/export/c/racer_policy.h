/* A drone-racing policy for a flight computer: states in, setpoints out, 100 times a second.
 *
 *     racer_pilot pilot;
 *     if (racer_self_test() != 0) { refuse to arm; }
 *     racer_reset(&pilot);
 *     every 10 ms: flags = racer_step(&pilot, &state, &setpoint);
 *
 * World frame ENU (x east, y north, z up), body frame x forward, y left, z up, quaternions (w, x, y, z) from body to
 * world, SI units and radians. C99; no allocation, no library. No rights are claimed in this file. */

#ifndef RACER_POLICY_H
#define RACER_POLICY_H

#include "racer_policy_data.h"

#ifdef __cplusplus
extern "C" {
#endif

/* What the computer knows of the vehicle, all of one moment. */
typedef struct {
    float position[3];  /* world, m */
    float velocity[3];  /* world, m/s */
    float attitude[4];  /* w, x, y, z */
    float body_rate[3]; /* measured, about body x, y, z, rad/s */
    float voltage;      /* at the battery's terminals, V */
} racer_state;

/* What the flight controller is to be sent. */
typedef struct {
    float action[RACER_ACTIONS]; /* the policy's answer, -1..1: roll, pitch, yaw, thrust */
    float body_rate[3];          /* about body x, y, z, rad/s */
    float throttle;              /* 0..1 */
    float thrust_n;              /* what this throttle settles at with this voltage, N */
    float thrust_to_weight;      /* the same over the vehicle's weight */
} racer_setpoint;

/* What is kept from step to step. */
typedef struct {
    float command[RACER_ACTIONS];    /* filtered commands: how far the vehicle has followed, by the model */
    float history[3][RACER_ACTIONS]; /* the last three actions, newest first */
    float position[3];               /* of the last usable state */
    int moved;                       /* whether there was one */
    int target;                      /* the gate that comes next, counted from 0 */
    float observation[RACER_OBSERVATIONS]; /* the last one, for logs */
    int outside;                     /* its first entry outside the range, or -1 */
} racer_pilot;

/* Flags of a step, or-ed. */
#define RACER_PASSED 1u    /* the gate was passed since the last step: target is the next one now */
#define RACER_MISSED 2u    /* its plane was crossed outside the aperture: give control back */
#define RACER_OUTSIDE 4u   /* the observation is outside the range of the training's flights */
#define RACER_BAD_INPUT 8u /* a number of the state is not finite, huge, or no unit quaternion: the setpoint is level
                              rates and the throttle that carries the vehicle, to bridge one lost sample, not two */

/* On the pad: nothing was commanded yet, gate 0 comes next. */
void racer_reset(racer_pilot *pilot);

/* In flight, before gate `target`, where `action` was held for long enough. */
void racer_reset_at(racer_pilot *pilot, int target, const float action[RACER_ACTIONS]);

/* One control period of 10 ms. Always fills the setpoint. */
unsigned racer_step(racer_pilot *pilot, const racer_state *state, racer_setpoint *setpoint);

/* The network alone. */
void racer_policy(const float observation[RACER_OBSERVATIONS], float action[RACER_ACTIONS]);

/* Flies the steps of a recorded lap (racer_self_test.c, racer_self_test_data.c). 0 where target, observation, action
 * and setpoint are those of the simulator; else 10 (step + 1) plus 1 for the target, 2 for the observation, 3 for the
 * action, 4 for the setpoint. */
int racer_self_test(void);

#ifdef __cplusplus
}
#endif

#endif
