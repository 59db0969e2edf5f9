/* What the flash of an STM32H743 does more than flash_model.h says. */
#ifndef TAKT_TESTS_H743_FLASH_MODEL_H
#define TAKT_TESTS_H743_FLASH_MODEL_H

#include <stdint.h>

/* Power has failed while the word here was being programmed: its code fits nothing. */
void h743_flash_model_tear(uint32_t offset);

#endif
