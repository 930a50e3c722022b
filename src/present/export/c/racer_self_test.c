/* Flies the recorded steps of racer_self_test_data.c. No rights are claimed in this file. */

#include "racer_policy.h"

/* Whether all `count` numbers are within `tolerance[i]` of those expected; one that is not a number is not. */
static int near(const float *found, const float *expected, const float *tolerance, int count)
{
    for (int i = 0; i < count; i++) {
        const float off = found[i] - expected[i];
        if (!(off <= tolerance[i] && off >= -tolerance[i])) {
            return 0;
        }
    }
    return 1;
}

/* All entries within one tolerance. */
static int all_near(const float *found, const float *expected, float tolerance, int count)
{
    for (int i = 0; i < count; i++) {
        if (!near(found + i, expected + i, &tolerance, 1)) {
            return 0;
        }
    }
    return 1;
}

static racer_state state_of(const float row[RACER_STATE])
{
    racer_state state;
    for (int i = 0; i < 3; i++) {
        state.position[i] = row[i];
        state.velocity[i] = row[3 + i];
        state.body_rate[i] = row[10 + i];
    }
    for (int i = 0; i < 4; i++) {
        state.attitude[i] = row[6 + i];
    }
    state.voltage = row[13];
    return state;
}

int racer_self_test(void)
{
    racer_pilot pilot;
    racer_reset_at(&pilot, racer_test_target[0], racer_start);
    for (int k = 0; k < RACER_ACTIONS; k++) {
        pilot.command[k] = racer_test_observation[0][18 + k];
        pilot.history[0][k] = racer_test_observation[0][22 + k];
        pilot.history[1][k] = racer_test_observation[0][26 + k];
        pilot.history[2][k] = racer_test_observation[0][30 + k];
    }
    for (int step = 0; step < RACER_TEST_STEPS; step++) {
        const racer_state state = state_of(racer_test_state[step]);
        racer_setpoint setpoint;
        (void)racer_step(&pilot, &state, &setpoint);
        const float sent[6] = {setpoint.body_rate[0], setpoint.body_rate[1], setpoint.body_rate[2],
                               setpoint.throttle,     setpoint.thrust_n,     setpoint.thrust_to_weight};
        const int place = 10 * (step + 1);
        if (pilot.target != racer_test_target[step]) {
            return place + 1;
        }
        if (!all_near(pilot.observation, racer_test_observation[step], racer_test_tolerance, RACER_OBSERVATIONS)) {
            return place + 2;
        }
        if (!all_near(setpoint.action, racer_test_action[step], racer_test_tolerance, RACER_ACTIONS)) {
            return place + 3;
        }
        if (!near(sent, racer_test_setpoint[step], racer_test_setpoint_tolerance, 6)) {
            return place + 4;
        }
    }
    return 0;
}
