#include "apps/freepath/run.h"

int main(int argc, char** argv) { return freepath::program::run(argc, argv); }
