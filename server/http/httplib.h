// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <httplib.h>

// The macro of resolv.h, which cpp-httplib includes, is a name in the headers of Eigen.
#undef _res
