#ifndef DUET_CLIENT_BATCH_FILE_NAME_H_
#define DUET_CLIENT_BATCH_FILE_NAME_H_

#include <string>

namespace duet::client::batch {

// `name`, a path of several parts without an ending, as file systems and archives can hold it: a
// part of more than 200 bytes becomes its beginning and the digest of the whole part, "long_..._" +
// 16 hex digits; a path that is still longer than 1000 bytes becomes a single such part. Short
// names stay as they are, different ones stay different, and the same name always gives the same.
std::string FitFileName(const std::string& name);

// `text` with each byte that is not UTF-8 replaced by '_', so that JSON can hold it.
std::string AsUtf8(const std::string& text);

}  // namespace duet::client::batch

#endif  // DUET_CLIENT_BATCH_FILE_NAME_H_
