#include "classic/classic.h"

bool takt_classic_is_there(void)
{
    return true;
}
