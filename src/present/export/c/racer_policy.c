/* See racer_policy.h. No rights are claimed in this file. */

#include "racer_policy.h"

/* Beyond this a state or an observation is no number to compute with. */
#define HUGE_NUMBER 1e6f

/* What another order of operations may move an entry of the observation. */
#define ROUNDING 1e-4f

/* Absolute error below 7e-7, never outside -1..1. */
static float racer_tanh(float x)
{
    const float limited = x > 7.5f ? 7.5f : (x < -7.5f ? -7.5f : x);
    const float s = limited * limited;
    const float p =
        0.99999945805f + s * (0.127438028633f + s * (0.00272932616035f + s * (7.4232515070e-6f - s * 6.6437668198e-9f)));
    const float q = 1.0f + s * (0.460769305755f + s * (0.0229880491420f + s * 2.0107685233e-4f));
    return limited * p / q;
}

/* out = tanh(in W + b), eight columns of W at a time. Weights are [inputs][outputs]. */
static void layer8(const float *weight, const float *bias, const float *in, int inputs, int outputs, float *out)
{
    for (int j = 0; j < outputs; j += 8) {
        const float *w = weight + j;
        float a = bias[j], b = bias[j + 1], c = bias[j + 2], d = bias[j + 3];
        float e = bias[j + 4], f = bias[j + 5], g = bias[j + 6], h = bias[j + 7];
        for (int i = 0; i < inputs; i++) {
            const float x = in[i];
            a += x * w[0];
            b += x * w[1];
            c += x * w[2];
            d += x * w[3];
            e += x * w[4];
            f += x * w[5];
            g += x * w[6];
            h += x * w[7];
            w += outputs;
        }
        out[j] = racer_tanh(a);
        out[j + 1] = racer_tanh(b);
        out[j + 2] = racer_tanh(c);
        out[j + 3] = racer_tanh(d);
        out[j + 4] = racer_tanh(e);
        out[j + 5] = racer_tanh(f);
        out[j + 6] = racer_tanh(g);
        out[j + 7] = racer_tanh(h);
    }
}

void racer_policy(const float observation[RACER_OBSERVATIONS], float action[RACER_ACTIONS])
{
    float first[RACER_HIDDEN], second[RACER_HIDDEN];
    layer8(racer_weight_0, racer_bias_0, observation, RACER_OBSERVATIONS, RACER_HIDDEN, first);
    layer8(racer_weight_1, racer_bias_1, first, RACER_HIDDEN, RACER_HIDDEN, second);
    for (int j = 0; j < RACER_ACTIONS; j++) {
        float sum = racer_bias_2[j];
        for (int i = 0; i < RACER_HIDDEN; i++) {
            sum += second[i] * racer_weight_2[i * RACER_ACTIONS + j];
        }
        action[j] = racer_tanh(sum);
    }
}

static int ordinary(const float *numbers, int count)
{
    for (int i = 0; i < count; i++) {
        /* Also false for what is not a number. */
        if (!(numbers[i] > -HUGE_NUMBER && numbers[i] < HUGE_NUMBER)) {
            return 0;
        }
    }
    return 1;
}

static int usable(const racer_state *state)
{
    const float *q = state->attitude;
    if (!ordinary(state->position, 3) || !ordinary(state->velocity, 3) || !ordinary(q, 4) ||
        !ordinary(state->body_rate, 3) || !ordinary(&state->voltage, 1)) {
        return 0;
    }
    const float square = q[0] * q[0] + q[1] * q[1] + q[2] * q[2] + q[3] * q[3];
    return square > 0.98f && square < 1.02f;
}

/* A world vector in the frame of a gate. */
static void into_gate(const racer_gate *gate, const float world[3], float out[3])
{
    for (int i = 0; i < 3; i++) {
        out[i] = gate->axes[i][0] * world[0] + gate->axes[i][1] * world[1] + gate->axes[i][2] * world[2];
    }
}

/* A world point in the frame of a gate. */
static void locate(const racer_gate *gate, const float point[3], float out[3])
{
    const float offset[3] = {point[0] - gate->centre[0], point[1] - gate->centre[1], point[2] - gate->centre[2]};
    into_gate(gate, offset, out);
}

/* Compares the last two positions with the target gate's plane. */
static unsigned cross(racer_pilot *pilot, const float position[3])
{
    unsigned flags = 0;
    if (pilot->moved) {
        const racer_gate *gate = &racer_gates[pilot->target];
        float before[3], after[3];
        locate(gate, pilot->position, before);
        locate(gate, position, after);
        if (before[0] < 0.0f && after[0] >= 0.0f) {
            const float share = before[0] / (before[0] - after[0]);
            const float y = before[1] + share * (after[1] - before[1]);
            const float z = before[2] + share * (after[2] - before[2]);
            if (y * y + z * z <= gate->radius * gate->radius) {
                pilot->target = pilot->target + 1 < RACER_GATES ? pilot->target + 1 : 0;
                flags = RACER_PASSED;
            } else {
                flags = RACER_MISSED;
            }
        }
    }
    for (int i = 0; i < 3; i++) {
        pilot->position[i] = position[i];
    }
    pilot->moved = 1;
    return flags;
}

/* The body's axes in the world, one a row. */
static void body_axes(const float q[4], float axes[3][3])
{
    const float w = q[0], x = q[1], y = q[2], z = q[3];
    axes[0][0] = 1.0f - 2.0f * (y * y + z * z);
    axes[0][1] = 2.0f * (x * y + w * z);
    axes[0][2] = 2.0f * (x * z - w * y);
    axes[1][0] = 2.0f * (x * y - w * z);
    axes[1][1] = 1.0f - 2.0f * (x * x + z * z);
    axes[1][2] = 2.0f * (y * z + w * x);
    axes[2][0] = 2.0f * (x * z + w * y);
    axes[2][1] = 2.0f * (y * z - w * x);
    axes[2][2] = 1.0f - 2.0f * (x * x + y * y);
}

static void observe(racer_pilot *pilot, const racer_state *state)
{
    const racer_gate *gate = &racer_gates[pilot->target];
    float *out = pilot->observation;
    float axes[3][3];
    body_axes(state->attitude, axes);
    locate(gate, state->position, out);
    into_gate(gate, state->velocity, out + 3);
    for (int k = 0; k < 3; k++) {
        into_gate(gate, axes[k], out + 6 + 3 * k);
    }
    for (int i = 0; i < 3; i++) {
        out[15 + i] = out[6 + i] * state->body_rate[0] + out[9 + i] * state->body_rate[1] +
                      out[12 + i] * state->body_rate[2];
        out[35 + i] = gate->next[i];
        out[38 + i] = gate->second[i];
    }
    for (int k = 0; k < RACER_ACTIONS; k++) {
        out[18 + k] = pilot->command[k];
        out[22 + k] = pilot->history[0][k];
        out[26 + k] = pilot->history[1][k];
        out[30 + k] = pilot->history[2][k];
    }
    out[34] = state->voltage;
    pilot->outside = -1;
    for (int k = RACER_OBSERVATIONS - 1; k >= 0; k--) {
        out[k] = (out[k] - racer_offset[k]) * racer_scale[k];
        if (!(out[k] >= racer_low[k] - ROUNDING && out[k] <= racer_high[k] + ROUNDING)) {
            pilot->outside = k;
        }
    }
}

static void remember(racer_pilot *pilot, const float action[RACER_ACTIONS])
{
    for (int k = 0; k < RACER_ACTIONS; k++) {
        pilot->command[k] += racer_share[k] * (action[k] - pilot->command[k]);
        pilot->history[2][k] = pilot->history[1][k];
        pilot->history[1][k] = pilot->history[0][k];
        pilot->history[0][k] = action[k];
    }
}

static void ask(racer_setpoint *setpoint, float voltage)
{
    const float u = setpoint->action[3];
    const float *c = racer_thrust;
    for (int k = 0; k < 3; k++) {
        setpoint->body_rate[k] = setpoint->action[k] * racer_full_rate[k];
    }
    setpoint->throttle = 0.5f * (u + 1.0f);
    setpoint->thrust_n = c[0] + u * (c[1] + u * (c[2] + u * c[3])) + voltage * (c[4] + u * c[5]);
    setpoint->thrust_to_weight = setpoint->thrust_n / racer_weight_n;
}

void racer_reset_at(racer_pilot *pilot, int target, const float action[RACER_ACTIONS])
{
    for (int k = 0; k < RACER_ACTIONS; k++) {
        pilot->command[k] = action[k];
        pilot->history[0][k] = action[k];
        pilot->history[1][k] = action[k];
        pilot->history[2][k] = action[k];
    }
    for (int i = 0; i < 3; i++) {
        pilot->position[i] = 0.0f;
    }
    for (int k = 0; k < RACER_OBSERVATIONS; k++) {
        pilot->observation[k] = 0.0f;
    }
    pilot->moved = 0;
    pilot->target = target > 0 && target < RACER_GATES ? target : 0;
    pilot->outside = -1;
}

void racer_reset(racer_pilot *pilot)
{
    racer_reset_at(pilot, 0, racer_start);
}

unsigned racer_step(racer_pilot *pilot, const racer_state *state, racer_setpoint *setpoint)
{
    unsigned flags = RACER_BAD_INPUT;
    if (usable(state)) {
        flags = cross(pilot, state->position);
        observe(pilot, state);
        if (pilot->outside >= 0) {
            flags |= RACER_OUTSIDE;
        }
        racer_policy(pilot->observation, setpoint->action);
        ask(setpoint, state->voltage);
    } else {
        for (int k = 0; k < 3; k++) {
            setpoint->action[k] = 0.0f;
        }
        setpoint->action[3] = racer_hover;
        ask(setpoint, racer_half_full);
    }
    remember(pilot, setpoint->action);
    return flags;
}
