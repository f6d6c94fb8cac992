#pragma once

// OpenNI2's driver headers. They need two macros from a library that Debian does not ship.
#define XN_NEW(type, argument) new type(argument)
#define XN_DELETE(pointer) delete (pointer)
#include <Driver/OniDriverAPI.h>
