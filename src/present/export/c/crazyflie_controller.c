/* An out-of-tree controller for the Crazyflie: the policy gives body rates and throttle, the firmware's own rate
 * controller follows them. With -DRACER_IN_FIRMWARE the firmware's headers are taken; without, the few declarations
 * below, so that this file compiles alone. Nothing of it was flown by us. No rights are claimed in this file.
 *
 * The policy has to be trained in a vehicle identified from this one: thrust above all. Yaw: the stock controller turns
 * a yaw rate into a heading to hold, which is slower than the yaw response that the policy was trained with. */

#include "racer_policy.h"
#include <stdbool.h>
#include <stdint.h>

#ifdef RACER_IN_FIRMWARE
#include "controller.h"
#include "controller_pid.h"
#include "pm.h"
#else
typedef struct { float x, y, z; } vector;
typedef struct { float x, y, z, w; } quaternion;
typedef struct { float roll, pitch, yaw; } angles;
enum { modeDisable, modeAbs, modeVelocity };
typedef struct { int x, y, z, roll, pitch, yaw; } modes;
typedef struct { angles attitudeRate; float thrust; modes mode; } setpoint_t;
typedef struct { vector gyro; } sensorData_t;
typedef struct { vector position, velocity; quaternion attitudeQuaternion; } state_t;
typedef struct { float thrust; } control_t;
typedef uint32_t stabilizerStep_t;
void controllerPidInit(void);
bool controllerPidTest(void);
void controllerPid(control_t *, const setpoint_t *, const sensorData_t *, const state_t *, stabilizerStep_t);
float pmGetBatteryVoltage(void);
void controllerOutOfTreeInit(void);
bool controllerOutOfTreeTest(void);
void controllerOutOfTree(control_t *, const setpoint_t *, const sensorData_t *, const state_t *, stabilizerStep_t);
#endif

#define DEGREES 57.29578f
#define STEPS_PER_PERIOD 10u /* the stabilizer runs at 1 kHz, the policy at 100 Hz */

static racer_pilot pilot;
static racer_setpoint told;
static bool lost = true;

void controllerOutOfTreeInit(void)
{
    controllerPidInit();
    racer_reset(&pilot);
    lost = false;
}

bool controllerOutOfTreeTest(void)
{
    return controllerPidTest() && racer_self_test() == 0;
}

static racer_state estimate(const sensorData_t *sensors, const state_t *state)
{
    const racer_state now = {
        {state->position.x, state->position.y, state->position.z},
        {state->velocity.x, state->velocity.y, state->velocity.z},
        {state->attitudeQuaternion.w, state->attitudeQuaternion.x, state->attitudeQuaternion.y,
         state->attitudeQuaternion.z},
        {sensors->gyro.x / DEGREES, sensors->gyro.y / DEGREES, sensors->gyro.z / DEGREES},
        pmGetBatteryVoltage()};
    return now;
}

void controllerOutOfTree(control_t *control, const setpoint_t *setpoint, const sensorData_t *sensors,
                         const state_t *state, const stabilizerStep_t step)
{
    /* The commander's thrust is the dead-man's switch: without it the policy begins anew on the pad. */
    if (setpoint->thrust <= 0.0f) {
        racer_reset(&pilot);
        lost = false;
        controllerPid(control, setpoint, sensors, state, step);
        return;
    }
    if (!lost && step % STEPS_PER_PERIOD == 0u) {
        const racer_state now = estimate(sensors, state);
        const unsigned flags = racer_step(&pilot, &now, &told);
        lost = (flags & (RACER_MISSED | RACER_BAD_INPUT)) != 0u;
    }
    if (lost) {
        controllerPid(control, setpoint, sensors, state, step);
        return;
    }
    setpoint_t rates = *setpoint;
    rates.mode.x = modeDisable;
    rates.mode.y = modeDisable;
    rates.mode.z = modeDisable;
    rates.mode.roll = modeVelocity;
    rates.mode.pitch = modeVelocity;
    rates.mode.yaw = modeVelocity;
    rates.attitudeRate.roll = told.body_rate[0] * DEGREES;
    rates.attitudeRate.pitch = -told.body_rate[1] * DEGREES; /* the firmware's pitch is positive nose up */
    rates.attitudeRate.yaw = told.body_rate[2] * DEGREES;
    rates.thrust = 65535.0f * told.throttle;
    controllerPid(control, &rates, sensors, state, step);
}
