#include "daemon/auth/account.h"

namespace hydroprint::auth {

const char* name_of(Role role) {
  switch (role) {
    case Role::kViewer:
      return "VIEWER";
    case Role::kMaker:
      return "MAKER";
    case Role::kOperator:
      return "OPERATOR";
    case Role::kAdmin:
      return "ADMIN";
  }
  return "NONE";
}

}  // namespace hydroprint::auth
