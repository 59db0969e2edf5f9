/*
 * Built where libwebsockets is missing.
 */
#include "page/page_server.h"

bool page_server_is_there(void)
{
    return false;
}

struct page_server *page_server_open(const struct page_server_config *config, const char **problem)
{
    (void)config;
    *problem = "built without libwebsockets";
    return NULL;
}

void page_server_close(struct page_server *server)
{
    (void)server;
}

uint16_t page_server_get_port(const struct page_server *server)
{
    (void)server;
    return 0;
}
