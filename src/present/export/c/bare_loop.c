/* A bare loop: states from somewhere, setpoints to somewhere, every 10 ms.
 *
 *     cc -std=c99 -O2 -I.. bare_loop.c ../racer_policy.c ../racer_policy_data.c ../racer_self_test.c \
 *         ../racer_self_test_data.c -o bare_loop
 *
 * As it stands it flies nothing: it asks the policy once, for the vehicle at rest on the pad. No rights are claimed in
 * this file. */

#include "racer_policy.h"
#include <stdio.h>

/* The newest estimate of your vehicle. Here: on the pad, as the policy's training began. */
static racer_state newest_state(void)
{
    racer_state state = {{0}, {0}, {1.0f, 0.0f, 0.0f, 0.0f}, {0}, 0.0f};
    for (int i = 0; i < 3; i++) {
        state.position[i] = racer_pad[i];
    }
    state.attitude[0] = racer_pad[3];
    state.attitude[3] = racer_pad[4];
    state.voltage = racer_pad[5];
    return state;
}

/* To your flight controller. */
static void send(const racer_setpoint *setpoint)
{
    printf("body rates %.3f %.3f %.3f rad/s, throttle %.3f\n", (double)setpoint->body_rate[0],
           (double)setpoint->body_rate[1], (double)setpoint->body_rate[2], (double)setpoint->throttle);
}

int main(void)
{
    const int failed = racer_self_test();
    printf("policy %s, self-test %d\n", RACER_POLICY_SHA256, failed);
    if (failed != 0) {
        return 1;
    }
    racer_pilot pilot;
    racer_reset(&pilot);
    for (int period = 0; period < 1; period++) { /* for ever, every 10 ms */
        const racer_state state = newest_state();
        racer_setpoint setpoint;
        const unsigned flags = racer_step(&pilot, &state, &setpoint);
        if ((flags & (RACER_MISSED | RACER_BAD_INPUT)) != 0u) {
            return 2; /* hand control back */
        }
        send(&setpoint);
    }
    return 0;
}
