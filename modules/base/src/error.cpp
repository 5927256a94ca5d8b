#include "drape/base/error.hpp"

namespace drape {

int exit_code(ErrorCode code) {
  switch (code) {
    case ErrorCode::config:
      return 64;
    case ErrorCode::input:
      return 65;
    case ErrorCode::bug:
      return 70;
    case ErrorCode::io:
      return 74;
    case ErrorCode::try_again:
      return 75;
  }
  return 70;
}

}  // namespace drape
