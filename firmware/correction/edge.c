#include "correction/edge.h"

#include "base/assert.h"

double takt_edge_hold(double position, double last, unsigned *outside)
{
    if (position >= 0.0 && position <= last) {
        return position;
    }
    const double end = position < 0.0 ? 0.0 : last;
    const double s = position - end;
    const double q = s < 0.0 ? -s : s;
    const double left = 1.0 - q;

    *outside = 1;
    return q < 1.0 ? end + s * left * left * left * (1.0 + 3.0 * q) : end;
}
