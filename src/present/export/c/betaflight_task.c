/* A task for Betaflight: from a state to the four sticks of acro mode. It compiles alone; the three places marked
 * CONNECT are where the firmware comes in. The signs are those that flew in Betaflight's own simulator build; nothing
 * of it was flown on a vehicle by us. No rights are claimed in this file.
 *
 * The firmware has to turn sticks into rates straight: rates_type = ACTUAL with centre sensitivity and maximum rate
 * both racer_full_rate in deg/s, no expo, no deadband, no rc smoothing, throttle curve and boost off. Its mixer moves
 * the collective when rates demand it: see what that costs in `racer identify` before a race. */

#include "racer_policy.h"
#include <stdint.h>

/* Pulses of roll, pitch, throttle, yaw, us: the order AETR. */
void racer_betaflight_sticks(const racer_setpoint *setpoint, uint16_t sticks[4])
{
    const float *a = setpoint->action;
    sticks[0] = (uint16_t)(1500.5f + 500.0f * a[0]);
    sticks[1] = (uint16_t)(1500.5f + 500.0f * a[1]); /* forward stick: nose down, which is positive */
    sticks[2] = (uint16_t)(1000.5f + 1000.0f * setpoint->throttle);
    sticks[3] = (uint16_t)(1500.5f - 500.0f * a[2]); /* right stick: turn right, which is negative */
}

typedef struct {
    racer_pilot pilot;
    int armed;    /* the policy has the sticks */
    int unusable; /* bad states in a row */
} racer_betaflight;

/* Before the policy is given the sticks. Returns whether it may. */
int racer_betaflight_begin(racer_betaflight *task)
{
    racer_reset(&task->pilot);
    task->unusable = 0;
    task->armed = racer_self_test() == 0;
    return task->armed;
}

/* Every 10 ms. `state` is from motion capture or an estimator, in the frames of racer_policy.h (CONNECT: the firmware's
 * own gyro and attitude have other signs; racer_self_test cannot see that, turning the vehicle by hand can). Returns
 * whether `sticks` are to replace the pilot's (CONNECT: rcData, or MSP_SET_RAW_RC from a companion). */
int racer_betaflight_task(racer_betaflight *task, const racer_state *state, uint16_t sticks[4])
{
    racer_setpoint setpoint;
    if (!task->armed) {
        return 0;
    }
    const unsigned flags = racer_step(&task->pilot, state, &setpoint);
    task->unusable = (flags & RACER_BAD_INPUT) != 0u ? task->unusable + 1 : 0;
    if ((flags & RACER_MISSED) != 0u || task->unusable > 1) {
        task->armed = 0; /* CONNECT: the pilot, or the failsafe, has it from here */
        return 0;
    }
    racer_betaflight_sticks(&setpoint, sticks);
    return 1;
}
