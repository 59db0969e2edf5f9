#include "canopen/target_pdo.h"
#include "canopen/cia402.h"

void target_pdo_set(struct pdo *pdo, const uint8_t node[], unsigned count, unsigned index)
{
    unsigned first = index & ~1u;
    bool paired = first + 1 < count;
    uint32_t objects[2] = {PDO_DUMMY_32, PDO_DUMMY_32};
    objects[index - first] = CIA402_TARGET_POSITION;
    pdo->cob_id = (uint16_t)(PDO_RPDO2_FUNCTION + node[first]);
    pdo->transmission = PDO_EVERY_SYNC;
    (void)pdo_map(&pdo->mapping, objects, paired ? 2 : 1);
}
