#include "canopen/target_pdo.h"
#include "base/assert.h"
#include "canopen/cia402.h"

unsigned takt_target_pdo_members(unsigned count, unsigned index, unsigned group)
{
    const unsigned left = count - (index - index % group);
    TAKT_ASSERT(index < count && group > 0);
    return left < group ? left : group;
}

void takt_target_pdo_set(struct pdo *pdo, const uint8_t node[], unsigned count, unsigned index,
                         unsigned group)
{
    uint32_t objects[TARGET_PDO_FD];
    TAKT_ASSERT(index < count && group > 0 && group <= TARGET_PDO_FD);
    for (unsigned i = 0; i < TARGET_PDO_FD; i++)
        objects[i] = i == index % group ? CIA402_TARGET_POSITION : PDO_DUMMY_32;
    pdo->cob_id = (uint16_t)(PDO_RPDO2_FUNCTION + node[index - index % group]);
    pdo->transmission = PDO_EVERY_SYNC;
    (void)takt_pdo_map(&pdo->mapping, objects, takt_target_pdo_members(count, index, group));
}
