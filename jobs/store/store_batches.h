// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <SQLiteCpp/SQLiteCpp.h>

namespace jobs {

/// A cluster still computes batches of a former program with a former engine, whose results are none of ours: takes their jobs back.
void release_batches_of_other_engines(SQLite::Database& database);

}  // namespace jobs
