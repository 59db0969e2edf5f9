#define _DEFAULT_SOURCE

#include "serve/serial_line.h"

#include <errno.h>
#include <fcntl.h>
#include <stddef.h>
#include <stdlib.h>
#include <string.h>
#include <termios.h>
#include <unistd.h>

#define BAUDS_DEFAULT 19200

static const struct {
    uint32_t bauds;
    speed_t speed;
} speeds[] = {
    {1200, B1200},   {2400, B2400},   {4800, B4800},     {9600, B9600},     {19200, B19200},
    {38400, B38400}, {57600, B57600}, {115200, B115200}, {230400, B230400},
};

static speed_t speed_of(uint32_t bauds)
{
    for (size_t i = 0; i < sizeof speeds / sizeof speeds[0]; i++) {
        if (speeds[i].bauds == bauds)
            return speeds[i].speed;
    }
    return B0;
}

static int set_up(int file, speed_t speed, enum serial_parity parity)
{
    struct termios settings;

    if (tcgetattr(file, &settings) != 0)
        return -1;
    cfmakeraw(&settings);
    settings.c_cflag |= CREAD | CLOCAL;
    settings.c_cflag &= ~(tcflag_t)(PARENB | PARODD | CSTOPB);
    if (parity == SERIAL_NONE)
        settings.c_cflag |= CSTOPB;
    else
        settings.c_cflag |= parity == SERIAL_ODD ? PARENB | PARODD : PARENB;
    settings.c_cc[VMIN] = 0;
    settings.c_cc[VTIME] = 0;
    if (cfsetispeed(&settings, speed) != 0 || cfsetospeed(&settings, speed) != 0)
        return -1;
    return tcsetattr(file, TCSANOW, &settings);
}

static bool read_parity(struct serial_settings *settings, const char *text)
{
    static const char *const names[] = {
        [SERIAL_EVEN] = "even", [SERIAL_ODD] = "odd", [SERIAL_NONE] = "none"};

    for (unsigned i = 0; i < sizeof names / sizeof names[0]; i++) {
        if (strcmp(text, names[i]) == 0) {
            settings->parity = (enum serial_parity)i;
            return true;
        }
    }
    return false;
}

bool serial_settings_read(struct serial_settings *settings, const char *text)
{
    const size_t length = strcspn(text, ",");
    char *end;

    if (length == 0 || length > SERIAL_PATH_MAX)
        return false;
    memset(settings, 0, sizeof *settings);
    memcpy(settings->path, text, length);
    settings->bauds = BAUDS_DEFAULT;
    settings->parity = SERIAL_EVEN;
    if (text[length] == '\0')
        return true;
    settings->bauds = (uint32_t)strtoul(text + length + 1, &end, 10);
    if (speed_of(settings->bauds) == B0)
        return false;
    return *end == '\0' || (*end == ',' && read_parity(settings, end + 1));
}

int serial_line_open(const struct serial_settings *settings)
{
    const int file = open(settings->path, O_RDWR | O_NOCTTY | O_NONBLOCK | O_CLOEXEC);

    if (file >= 0 && set_up(file, speed_of(settings->bauds), settings->parity) != 0) {
        const int reason = errno;

        (void)close(file);
        errno = reason;
        return -1;
    }
    return file;
}
