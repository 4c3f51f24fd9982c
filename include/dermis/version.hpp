/// The version of dermis. The build reads it from here, so it is stated once.
#pragma once

#define DERMIS_VERSION_MAJOR 0
#define DERMIS_VERSION_MINOR 1
#define DERMIS_VERSION_PATCH 0
#define DERMIS_VERSION "0.1.0"
