// Submission: from the bytes of a POST to what the store takes, with every fault that is known so far.
//
// Errors  the client's are a value; nothing is stored or queued here.
#pragma once

#include "api/job_request.h"
#include "server/jobs/job_service.h"
#include "server/jobs/live_jobs.h"

#include <variant>

namespace server {

struct Submission {
    SubmitRequest request; // with its id
    Sharing sharing;
};

std::variant<Submission, api::ProblemDetails> read_submission(const SubmitWords& words,
                                                              const renderer::Limits& limits,
                                                              const BlobStore& blobs,
                                                              const ImportService& imports);

// What a stored job is read again under: its files are where they were when it was accepted.
api::ReadContext context_of_stored(renderer::Limits limits);

} // namespace server
