#pragma once

#include <cstdio>
#include <cstdlib>

/// Ends the fuzzer with a finding if a claim does not hold.
#define HP_EXPECT(claim)                                                              \
  do {                                                                                \
    if (!(claim)) {                                                                   \
      std::fprintf(stderr, "%s:%d: does not hold: %s\n", __FILE__, __LINE__, #claim); \
      std::abort();                                                                   \
    }                                                                                 \
  } while (false)
