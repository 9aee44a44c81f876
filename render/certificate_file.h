// certificate_file.h -- certificates as JSON files. docs/certificates.md, "Certificate files", has the format.
#pragma once
#include <iosfwd>
#include <map>
#include <optional>
#include <string>

#include "certificate.h"

namespace isoparm {

/// A certificate, and of which surfaces it is.
struct CertificateFile {
    std::string scene, sha256;            // the scene file's name, without folders, and its digest
    std::optional<std::string> surface;   // --surface; otherwise all that the scene draws
    std::map<std::string, double> parameters;
    std::string measure;                  // "geometric" or "parametric": of the bounds that it was made from; none of the latter slides
    Certificate certificate;
};

/// Is it proved by points that slide along the surface, instead of points at equal parameters?
bool slides(const CertifiedTriangle& triangle);

/// One vertex, corner or triangle a line; numbers read back as the same doubles.
void write_certificate(std::ostream& out, const CertificateFile& file);

/// Keys in the order in which they are written; white space is free. Throws LocatedError "path:line:column: found ..., expected ...".
CertificateFile read_certificate(const std::string& text, const std::string& path);

}  // namespace isoparm
