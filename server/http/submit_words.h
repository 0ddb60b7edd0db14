// SubmitWords from POST /v1/jobs: JSON in whatever wrapping curl puts it, or multipart with the files that the scene
// names.
#pragma once

#include "renderer/description/limits.h"
#include "server/http/exchange.h"
#include "server/jobs/job_service.h"
#include "server/store/blob_store.h"
#include "server/store/store.h"

#include <variant>

namespace server {

// The files of a multipart request are stored as assets when it returns.
// 400, 411, 413, 415, 422, 503 as problems; StoreError is the world's.
std::variant<SubmitWords, api::ProblemDetails>
read_submit_words(Exchange& exchange, Store& store, BlobStore& blobs, const renderer::Limits& limits);

} // namespace server
