// commands/verify_certificate.h -- isoparm verify --certificate.
#pragma once
#include "commands/options.h"

namespace isoparm {
/// Checks the file of --certificate against the scene of --against, and against a mesh if there is one; returns the exit code.
int verify_certificate(const Options& options);
}
