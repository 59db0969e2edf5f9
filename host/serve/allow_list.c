#define _POSIX_C_SOURCE 200809L

#include "serve/allow_list.h"

#include <arpa/inet.h>
#include <netinet/in.h>
#include <stdlib.h>
#include <string.h>

#define ADDRESS_BITS 128
/* ::ffff:0:0/96 holds IPv4. */
#define MAPPED_BITS  96
#define MAPPED_BYTES 12
#define TEXT_MAX     63

static void map_ipv4(uint8_t *address, const void *ipv4)
{
    memset(address, 0, MAPPED_BYTES - 2);
    memset(address + MAPPED_BYTES - 2, 0xFF, 2);
    memcpy(address + MAPPED_BYTES, ipv4, 4);
}

/* Bits of the address family: what a text without '/' means. 0: no address. */
static unsigned read_address(struct allow_entry *entry, const char *text)
{
    uint8_t ipv4[4];

    if (inet_pton(AF_INET, text, ipv4) == 1) {
        map_ipv4(entry->address, ipv4);
        return ADDRESS_BITS - MAPPED_BITS;
    }
    return inet_pton(AF_INET6, text, entry->address) == 1 ? ADDRESS_BITS : 0;
}

/* False: text is not a number of bits up to most. */
static bool read_bits(const char *text, unsigned most, unsigned *bits)
{
    char *end;
    unsigned long value = strtoul(text, &end, 10);

    if (text[0] < '0' || text[0] > '9' || *end != '\0' || value > most)
        return false;
    *bits = (unsigned)value;
    return true;
}

bool allow_list_add(struct allow_list *list, const char *text)
{
    char address[TEXT_MAX + 1];
    size_t length = strcspn(text, "/");
    struct allow_entry *entry = &list->entry[list->count];
    unsigned most, bits;

    if (list->count == ALLOW_LIST_MAX || length > TEXT_MAX)
        return false;
    memcpy(address, text, length);
    address[length] = '\0';
    most = read_address(entry, address);
    bits = most;
    if (most == 0 || (text[length] == '/' && !read_bits(text + length + 1, most, &bits)))
        return false;
    entry->bits = ADDRESS_BITS - most + bits;
    list->count++;
    return true;
}

static bool is_in(const struct allow_entry *entry, const uint8_t *address)
{
    const unsigned bytes = entry->bits / 8, rest = entry->bits % 8;

    if (memcmp(entry->address, address, bytes) != 0)
        return false;
    return rest == 0 || (entry->address[bytes] ^ address[bytes]) >> (8 - rest) == 0;
}

bool allow_list_has(const struct allow_list *list, const struct sockaddr_storage *address)
{
    uint8_t bytes[16];

    if (address->ss_family == AF_INET)
        map_ipv4(bytes, &((const struct sockaddr_in *)address)->sin_addr);
    else if (address->ss_family == AF_INET6)
        memcpy(bytes, &((const struct sockaddr_in6 *)address)->sin6_addr, sizeof bytes);
    else
        return list->count == 0;
    for (unsigned i = 0; i < list->count; i++) {
        if (is_in(&list->entry[i], bytes))
            return true;
    }
    return list->count == 0;
}
