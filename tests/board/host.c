/* What an exported policy answers to states that no vehicle is in. Prints a line for each case. */

#include "racer_policy.h"
#include <math.h>
#include <stdio.h>

static racer_state recorded(int step)
{
    const float *row = racer_test_state[step];
    const racer_state state = {{row[0], row[1], row[2]}, {row[3], row[4], row[5]},
                               {row[6], row[7], row[8], row[9]}, {row[10], row[11], row[12]}, row[13]};
    return state;
}

static void told(const char *name, const racer_state *state)
{
    racer_pilot pilot;
    racer_setpoint s;
    racer_reset_at(&pilot, racer_test_target[0], racer_start);
    const unsigned flags = racer_step(&pilot, state, &s);
    const float sum = s.body_rate[0] + s.body_rate[1] + s.body_rate[2] + s.thrust_n + s.thrust_to_weight;
    const int fine = isfinite(sum) && s.throttle >= 0.0f && s.throttle <= 1.0f && isfinite(pilot.command[3]);
    printf("%s flags %u fine %d still %d weight %.2f\n", name, flags, fine,
           s.body_rate[0] == 0.0f && s.body_rate[1] == 0.0f, (double)s.thrust_to_weight);
}

int main(void)
{
    racer_state state = recorded(0);
    told("recorded", &state);
    state.position[1] = nanf("");
    told("not_a_number", &state);
    state = recorded(0);
    state.body_rate[2] = HUGE_VALF;
    told("infinite", &state);
    state = recorded(0);
    state.velocity[0] = 1e30f;
    told("huge", &state);
    state = recorded(0);
    for (int i = 0; i < 4; i++) {
        state.attitude[i] = 0.0f;
    }
    told("no_attitude", &state);
    state = recorded(0);
    state.position[2] += 500.0f;
    told("far_away", &state);

    /* Beside the gate, across its plane. */
    racer_pilot pilot;
    racer_setpoint setpoint;
    racer_reset(&pilot);
    unsigned flags = 0;
    for (int i = 0; i < 2; i++) {
        state = recorded(0);
        for (int k = 0; k < 3; k++) {
            const float along = i == 0 ? -0.1f : 0.1f;
            state.position[k] = racer_gates[0].centre[k] + along * racer_gates[0].axes[0][k] +
                                2.0f * racer_gates[0].radius * racer_gates[0].axes[1][k];
        }
        flags = racer_step(&pilot, &state, &setpoint);
    }
    printf("beside missed %d target %d\n", (flags & RACER_MISSED) != 0u, pilot.target);
    printf("self_test %d\n", racer_self_test());
    return 0;
}
