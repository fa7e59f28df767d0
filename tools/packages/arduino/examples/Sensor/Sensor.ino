// SPDX-License-Identifier: MIT
// Learns from a sensor of its own: when is it dark enough for the lamp? The percept is three numbers, the light on
// pin A0, how it changes, and the hour of a day of 24 seconds. Needs 16 KiB of memory. Action 1 switches the lamp on. Replace reward() by
// what your lamp is for. Every few minutes the serial port shows the tree that was learnt.
#include <rlvc.h>

const uint32_t ACTIONS = 2, CAPACITY = 60, CLASSES = 8;
const int SENSOR = A0;

static uint64_t memory[RLVC_AGENT_BYTES(ACTIONS, CAPACITY, CLASSES, RLVC_THRESHOLDS_PERCEPT_BYTES(3),
                                        RLVC_THRESHOLDS_FEATURE_BYTES, 4) / 8];
static rlvc_thresholds thresholds;
static rlvc_agent *agent;
static float before;

static void sense(float percept[3]) {
    percept[0] = analogRead(SENSOR);
    percept[1] = percept[0] - before;
    percept[2] = (float)(millis() / 1000 % 24);
    before = percept[0];
}

static float reward(const float percept[3], uint8_t lamp) {
    return lamp == (percept[0] < 300.0f) ? 1.0f : 0.0f;
}

static int write_serial(void *context, const char *text, size_t bytes) {
    (void)context;
    return Serial.write((const uint8_t *)text, bytes) != bytes;
}

void setup() {
    rlvc_domain domain;
    rlvc_config config;
    float percept[3];
    Serial.begin(115200);
    pinMode(LED_BUILTIN, OUTPUT);
    rlvc_thresholds_default(&thresholds, 3);
    thresholds.cutpoints = 7;
    rlvc_thresholds_domain(&thresholds, &domain);
    rlvc_config_default(&config, &domain, ACTIONS);
    config.capacity = CAPACITY;
    config.classes = CLASSES;
    config.features_at_once = 4;
    if (rlvc_agent_init(&config, &domain, memory, sizeof memory, &agent) != RLVC_OK)
        Serial.println("no agent");
    sense(percept);
    rlvc_begin(agent, percept);
}

void loop() {
    static uint32_t steps = 0;
    rlvc_choice choice;
    rlvc_progress progress;
    float percept[3], next[3];
    sense(percept);
    if (rlvc_act(agent, &choice) != RLVC_OK)
        return;
    digitalWrite(LED_BUILTIN, choice.action ? HIGH : LOW);
    delay(100);
    sense(next);
    rlvc_observe(agent, choice, reward(percept, choice.action), next, RLVC_GOES_ON);
    rlvc_learn(agent, 2000, &progress); // a slice, so that the loop keeps its period
    if (++steps % 1200 == 0)
        rlvc_print(agent, RLVC_PRINT_TEXT, write_serial, NULL);
}
