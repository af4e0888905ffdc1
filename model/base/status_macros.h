#ifndef DUET_MODEL_BASE_STATUS_MACROS_H_
#define DUET_MODEL_BASE_STATUS_MACROS_H_

#include <utility>

#include "absl/status/status.h"
#include "absl/status/statusor.h"

// For functions that return absl::Status or absl::StatusOr and pass errors on unchanged.

// Returns the status `expression` from the enclosing function unless it is OK.
#define DUET_RETURN_IF_ERROR(expression) \
  if (absl::Status duet_status = (expression); !duet_status.ok()) return duet_status

// Declares a variable, or assigns an object, with the value of the absl::StatusOr `expression`, or
// returns its error from the enclosing function. A type that contains a comma needs `auto`. Expands
// to several statements.
//
//   DUET_TRY(const Dataset dataset, ReadDataset(folder));
#define DUET_TRY(declaration, expression) \
  DUET_TRY_TO_(DUET_JOIN_(duet_result_, __LINE__), declaration, expression)

#define DUET_TRY_TO_(result, declaration, expression) \
  auto result = (expression);                         \
  if (!result.ok()) return result.status();           \
  declaration = *std::move(result)
#define DUET_JOIN_(a, b) DUET_JOIN_TOKENS_(a, b)
#define DUET_JOIN_TOKENS_(a, b) a##b

#endif  // DUET_MODEL_BASE_STATUS_MACROS_H_
