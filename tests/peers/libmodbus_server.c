/*
 * A Modbus TCP server as libmodbus's own examples make one: select, modbus_receive, modbus_reply.
 * Prints its port.
 */
#define _DEFAULT_SOURCE

#include <errno.h>
#include <modbus.h>
#include <netinet/in.h>
#include <stdio.h>
#include <sys/select.h>
#include <sys/socket.h>
#include <unistd.h>

#define REGISTERS 100
#define CLIENTS   8

static void serve(modbus_t *context, modbus_mapping_t *mapping, int client, fd_set *open)
{
    uint8_t request[MODBUS_TCP_MAX_ADU_LENGTH];
    int length;

    (void)modbus_set_socket(context, client);
    length = modbus_receive(context, request);
    if (length > 0)
        (void)modbus_reply(context, request, length, mapping);
    if (length >= 0)
        return;
    (void)close(client);
    FD_CLR(client, open);
}

static void print_port(int listener)
{
    struct sockaddr_in address;
    socklen_t size = sizeof address;

    (void)getsockname(listener, (struct sockaddr *)&address, &size);
    (void)printf("%u\n", (unsigned)ntohs(address.sin_port));
    (void)fflush(stdout);
}

static void run(modbus_t *context, modbus_mapping_t *mapping, int listener)
{
    fd_set open;
    int highest = listener;

    FD_ZERO(&open);
    FD_SET(listener, &open);
    for (;;) {
        fd_set ready = open;

        if (select(highest + 1, &ready, NULL, NULL, NULL) < 0)
            return;
        for (int file = 0; file <= highest; file++) {
            if (!FD_ISSET(file, &ready))
                continue;
            if (file != listener) {
                serve(context, mapping, file, &open);
                continue;
            }
            const int client = accept(listener, NULL, NULL);

            if (client >= 0 && client < FD_SETSIZE) {
                FD_SET(client, &open);
                highest = client > highest ? client : highest;
            }
        }
    }
}

int main(void)
{
    modbus_t *context = modbus_new_tcp("127.0.0.1", 0);
    modbus_mapping_t *mapping = modbus_mapping_new(REGISTERS, 0, REGISTERS, REGISTERS);
    int listener = context != NULL && mapping != NULL ? modbus_tcp_listen(context, CLIENTS) : -1;

    if (listener < 0) {
        (void)fprintf(stderr, "libmodbus does not listen: %s\n", modbus_strerror(errno));
        return 1;
    }
    print_port(listener);
    run(context, mapping, listener);
    return 0;
}
