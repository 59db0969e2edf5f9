/*
 * Nodes that answer a master under test as CiA 301 wants: boot-up after a reset, SDO responses.
 * What they answer can be set; what they are told is kept. They send nothing else by themselves.
 */
#ifndef TAKT_TESTS_FAKE_NODES_H
#define TAKT_TESTS_FAKE_NODES_H

#include "canopen/little_endian.h"
#include "canopen/nmt.h"
#include "canopen/sdo.h"

#include <string.h>

#define FAKE_NODES_PENDING 128
#define FAKE_NODES_WRITTEN 512
#define FAKE_NODES_RULES   16

/* An answer out of the ordinary. node 0: every node's. */
struct fake_rule {
    uint8_t node;
    uint32_t object;
    uint32_t value;      /* of a reading request */
    uint32_t abort_code; /* not 0: the request is aborted */
    uint32_t write_code; /* not 0: so it is if it writes */
    uint32_t taken_from; /* not 0: what it writes is taken all the same from this value on */
    unsigned silent;     /* how many requests are not answered */
};

struct fake_written {
    uint8_t node;
    uint32_t object, value;
    uint8_t length;
};

struct fake_nodes {
    unsigned pending_count, pending_read, written_count, rule_count;
    struct can_frame pending[FAKE_NODES_PENDING]; /* for the master to receive */
    struct fake_written written[FAKE_NODES_WRITTEN];
    struct fake_rule rule[FAKE_NODES_RULES];
    uint8_t mode[128]; /* shown as object 6061: what RPDO1 said */
    uint8_t mute;      /* this node says nothing; 0: none */
    uint8_t wordless;  /* nor does this one say that it has booted */
    unsigned resets[128], starts[128], holds[128];
    unsigned written_before_hold; /* values to nodes that may have started themselves */
    unsigned guards[128];         /* guarding frames */
    unsigned toggles;             /* NMT_TOGGLE: answers to them do as they should */
};

static inline struct can_frame *fake_nodes_add(struct fake_nodes *nodes)
{
    return &nodes->pending[nodes->pending_count++ % FAKE_NODES_PENDING];
}

static inline uint32_t fake_nodes_value(const struct fake_nodes *nodes, uint8_t node,
                                        uint32_t object)
{
    switch (sdo_index(object)) {
    case 0x1000:
        return 0x00020192;
    case 0x1005:
        return 0x80;
    case 0x6502:
        return 0xE1;
    case 0x6061:
        return nodes->mode[node];
    default:
        return 0;
    }
}

static inline struct fake_rule *fake_nodes_rule(struct fake_nodes *nodes, uint8_t node,
                                                uint32_t object)
{
    for (unsigned i = 0; i < nodes->rule_count; i++)
        if ((nodes->rule[i].node == 0 || nodes->rule[i].node == node) &&
            nodes->rule[i].object == object)
            return &nodes->rule[i];
    return NULL;
}

static inline void fake_nodes_keep(struct fake_nodes *nodes, uint8_t node, uint32_t object,
                                   const struct can_frame *frame)
{
    nodes->written_before_hold += nodes->holds[node] == 0;
    nodes->written[nodes->written_count++ % FAKE_NODES_WRITTEN] =
        (struct fake_written){node, object, little_endian_read32(frame->data + 4),
                              (uint8_t)(4 - sdo_unused_expedited(frame->data[0]))};
}

static inline void fake_nodes_answer(struct fake_nodes *nodes, const struct can_frame *frame)
{
    uint8_t node = (uint8_t)(frame->id - SDO_REQUEST_FUNCTION);
    uint32_t object = takt_sdo_read_object(frame);
    struct fake_rule *rule = fake_nodes_rule(nodes, node, object);
    bool is_upload = (frame->data[0] & SDO_COMMAND_MASK) == SDO_REQUEST_UPLOAD;
    uint32_t value = rule ? rule->value : fake_nodes_value(nodes, node, object);
    if (frame->data[0] == SDO_ABORT)
        return;
    if (rule && rule->silent > 0) {
        rule->silent--;
        return;
    }
    bool is_taken = rule && !is_upload && rule->taken_from != 0 &&
                    little_endian_read32(frame->data + 4) >= rule->taken_from;
    uint32_t code = !rule || is_taken                     ? 0
                    : !is_upload && rule->write_code != 0 ? rule->write_code
                                                          : rule->abort_code;
    if (code != 0) {
        takt_sdo_write_abort(fake_nodes_add(nodes), SDO_RESPONSE_FUNCTION, node, object, code);
        return;
    }
    if (!is_upload)
        fake_nodes_keep(nodes, node, object, frame);
    takt_sdo_write_initiate(fake_nodes_add(nodes), (uint16_t)(SDO_RESPONSE_FUNCTION + node),
                            is_upload ? SDO_RESPONSE_UPLOAD | SDO_EXPEDITED | SDO_SIZE_GIVEN
                                      : SDO_RESPONSE_DOWNLOAD,
                            object, is_upload ? value : 0);
}

static inline void fake_nodes_guard(struct fake_nodes *nodes, uint8_t node)
{
    struct can_frame *answer = fake_nodes_add(nodes);
    takt_nmt_write_heartbeat(answer, node, NMT_OPERATIONAL);
    if (nodes->guards[node]++ % 2 == 1)
        answer->data[0] |= (uint8_t)nodes->toggles;
}

/* A frame of the master. */
static inline void fake_nodes_take(struct fake_nodes *nodes, const struct can_frame *frame)
{
    uint8_t node = (uint8_t)(frame->id & 0x7F);
    if (frame->id == NMT_COMMAND_COB_ID) {
        node = frame->data[1];
        nodes->resets[node] += frame->data[0] == NMT_RESET_COMMUNICATION;
        nodes->starts[node] += frame->data[0] == NMT_START;
        nodes->holds[node] += frame->data[0] == NMT_ENTER_PREOPERATIONAL;
        if (frame->data[0] == NMT_RESET_COMMUNICATION && node != nodes->mute &&
            node != nodes->wordless)
            takt_nmt_write_heartbeat(fake_nodes_add(nodes), node, NMT_BOOTED);
    } else if (nmt_is_guard(frame, node)) {
        fake_nodes_guard(nodes, node);
    } else if (node != nodes->mute && (frame->id & 0x780) == SDO_REQUEST_FUNCTION) {
        fake_nodes_answer(nodes, frame);
    } else if ((frame->id & 0x780) == 0x200) {
        nodes->mode[node] = frame->data[2];
    }
}

static inline bool fake_nodes_receive(struct fake_nodes *nodes, struct can_frame *frame)
{
    if (nodes->pending_read == nodes->pending_count)
        return false;
    *frame = nodes->pending[nodes->pending_read++ % FAKE_NODES_PENDING];
    return true;
}

/* The value a node has been told last for an object; fails when it has not. */
static inline const struct fake_written *fake_nodes_told(const struct fake_nodes *nodes,
                                                         uint8_t node, uint32_t object)
{
    for (unsigned i = nodes->written_count; i-- > 0;)
        if (nodes->written[i].node == node && nodes->written[i].object == object)
            return &nodes->written[i];
    return NULL;
}

#endif
