/* Runs the self-test of an exported policy on an emulated Arm board (QEMU's mps2-an386, Cortex-M4, and mps2-an500,
 * Cortex-M7), and counts the instructions of a step.
 *
 * Under `-icount shift=0` an instruction takes a nanosecond of the board's time, and the SysTick timer, at 25 MHz, goes
 * down by one in 40 of them. Prints `self-test RESULT instructions-per-step N`, by semihosting. */

#include "racer_policy.h"
#include <stdint.h>

#define SYSTICK_CONTROL (*(volatile uint32_t *)0xE000E010u)
#define SYSTICK_RELOAD (*(volatile uint32_t *)0xE000E014u)
#define SYSTICK_NOW (*(volatile uint32_t *)0xE000E018u)
#define COPROCESSORS (*(volatile uint32_t *)0xE000ED88u)
#define INSTRUCTIONS_PER_TICK 40u
#define ROUNDS 16u

static void semihost(int operation, const void *argument)
{
    register int r0 __asm__("r0") = operation;
    register const void *r1 __asm__("r1") = argument;
    __asm__ volatile("bkpt 0xab" : "+r"(r0) : "r"(r1) : "memory");
}

static void print(const char *text)
{
    semihost(0x04, text); /* SYS_WRITE0 */
}

static void print_number(uint32_t number)
{
    char digits[12];
    char *at = digits + sizeof digits - 1;
    *at = 0;
    do {
        *--at = (char)('0' + number % 10u);
        number /= 10u;
    } while (number != 0u);
    print(at);
}

/* Ticks of all recorded steps, several times over; the state is read from the table outside of the time. */
static uint32_t steps_ticks(void)
{
    racer_pilot pilot;
    racer_setpoint setpoint;
    uint32_t ticks = 0;
    for (uint32_t round = 0; round < ROUNDS; round++) {
        racer_reset_at(&pilot, racer_test_target[0], racer_start);
        for (int step = 0; step < RACER_TEST_STEPS; step++) {
            const float *row = racer_test_state[step];
            const racer_state state = {{row[0], row[1], row[2]}, {row[3], row[4], row[5]},
                                       {row[6], row[7], row[8], row[9]}, {row[10], row[11], row[12]}, row[13]};
            const uint32_t before = SYSTICK_NOW;
            (void)racer_step(&pilot, &state, &setpoint);
            ticks += (before - SYSTICK_NOW) & 0xffffffu;
        }
    }
    return ticks;
}

/* Where the board begins; board.ld has its address. */
void reset(void);
void reset(void)
{
    COPROCESSORS |= 0xfu << 20; /* the floating-point unit */
    __asm__ volatile("dsb\n isb");
    SYSTICK_RELOAD = 0xffffffu;
    SYSTICK_NOW = 0;
    SYSTICK_CONTROL = 5; /* on, the processor's clock, no interrupt */
    print("self-test ");
    print_number((uint32_t)racer_self_test());
    print(" instructions-per-step ");
    print_number(steps_ticks() * INSTRUCTIONS_PER_TICK / (ROUNDS * (uint32_t)RACER_TEST_STEPS));
    print("\n");
    semihost(0x18, (const void *)0x20026); /* SYS_EXIT: the application ended */
    for (;;) {
    }
}
