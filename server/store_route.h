#pragma once

#include "server/message.h"
#include "server/routes.h"

namespace server {

Response get_store(const Call& call);  ///< a consistent copy of the whole store, as an SQLite file

}  // namespace server
