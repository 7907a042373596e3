// The tables of kernels with errors planted in what lanes do at scatterings; take the place of the
// library's own.

#include "tests/certify/planted/kernels.cpp"  // NOLINT(bugprone-suspicious-include)
