#include "classic/classic.h"

bool classic_is_there(void)
{
    return true;
}
