/*
 * Built where there are no interfaces, serial lines and sockets: in a page. The bus inside the
 * process is all there is.
 */
#include "link/link_private.h"
#include "link/stream.h"

static bool refuse(const struct link_spec *spec, struct link_error *error)
{
    (void)spec;
    return link_refuse(error, "only the embedded bus is there in this build of takt");
}

bool link_open_socketcan(struct link *link, const struct link_spec *spec, struct link_error *error)
{
    (void)link;
    return refuse(spec, error);
}

bool link_open_slcan(struct link *link, const struct link_spec *spec, struct link_error *error)
{
    (void)link;
    return refuse(spec, error);
}

bool link_open_socketcand(struct link *link, const struct link_spec *spec, struct link_error *error)
{
    (void)link;
    return refuse(spec, error);
}

bool link_serve_socketcand(struct link *link, const struct link_spec *spec,
                           struct link_error *error)
{
    (void)link;
    return refuse(spec, error);
}

bool stream_knows_baud(unsigned baud)
{
    (void)baud;
    return false;
}
