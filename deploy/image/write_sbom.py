#!/usr/bin/env python3
"""Writes the bill of materials of an image, SPDX 2.3 in JSON: Duet and every Debian package in dpkg's
records, with version, source package and the licences that its copyright file declares.

    write_sbom.py --version 1.0.0 --created 2026-01-01T00:00:00Z ROOT >duet.spdx.json

ROOT is the image's root: `var/lib/dpkg/status.d` (a record for each package) or `var/lib/dpkg/status`.
The same root and arguments give the same bytes.
"""

import argparse
import hashlib
import json
import pathlib
import re
import sys


def records(root):
    """dpkg's records of the installed packages as {field: value}, sorted by name."""
    folder = root / "var/lib/dpkg/status.d"
    files = sorted(folder.iterdir()) if folder.is_dir() else [root / "var/lib/dpkg/status"]
    found = []
    for file in files:
        for text in re.split(r"\n\n+", file.read_text(encoding="utf-8").strip()):
            fields = dict(re.findall(r"^([A-Za-z-]+): (.*)$", text, re.MULTILINE))
            if fields.get("Status", "").endswith(" installed"):
                found.append(fields)
    return sorted(found, key=lambda fields: fields["Package"])


def licences(root, package):
    """The short names that a copyright file in Debian's machine-readable form declares."""
    file = root / "usr/share/doc" / package / "copyright"
    if not file.is_file():
        return []
    text = file.read_text(encoding="utf-8", errors="replace")
    return sorted(set(re.findall(r"^License: (\S.*?)\s*$", text, re.MULTILINE)))


def source_of(fields):
    """The source package and its version, which security notices name."""
    name, version = fields.get("Source", fields["Package"]), fields["Version"]
    with_version = re.fullmatch(r"(\S+) \((\S+)\)", name)
    return with_version.groups() if with_version else (name, version)


def spdx_id(name):
    return "SPDXRef-" + re.sub(r"[^A-Za-z0-9.-]", "-", name)


def package_entry(root, fields):
    name, version = fields["Package"], fields["Version"]
    source, source_version = source_of(fields)
    declared = licences(root, name)
    locator = (f"pkg:deb/debian/{name}@{version}?arch={fields['Architecture']}"
               "&distro=debian-12").replace("+", "%2B")
    entry = {
        "SPDXID": spdx_id(f"package-{name}"),
        "name": name,
        "versionInfo": version,
        "supplier": "Organization: Debian",
        "downloadLocation": "NOASSERTION",
        "filesAnalyzed": False,
        "licenseConcluded": "NOASSERTION",
        "licenseDeclared": "NOASSERTION",
        "copyrightText": "NOASSERTION",
        "sourceInfo": f"built from the Debian source package {source} {source_version}",
        "externalRefs": [{"referenceCategory": "PACKAGE-MANAGER", "referenceType": "purl",
                          "referenceLocator": locator}],
    }
    if declared:
        # Debian's short names are not all SPDX identifiers.
        entry["licenseComments"] = "Debian's copyright file declares: " + ", ".join(declared)
    return entry


def document(root, version, created):
    packages = [package_entry(root, fields) for fields in records(root)]
    product = {
        "SPDXID": "SPDXRef-Duet",
        "name": "duet",
        "versionInfo": version,
        "downloadLocation": "NOASSERTION",
        "filesAnalyzed": False,
        "licenseConcluded": "Apache-2.0",
        "licenseDeclared": "Apache-2.0",
        "copyrightText": "NOASSERTION",
    }
    digest = hashlib.sha256(json.dumps([product, packages]).encode()).hexdigest()
    return {
        "spdxVersion": "SPDX-2.3",
        "dataLicense": "CC0-1.0",
        "SPDXID": "SPDXRef-DOCUMENT",
        "name": f"duet-{version}",
        "documentNamespace": f"urn:duet:sbom:{digest}",
        "creationInfo": {"created": created, "creators": ["Tool: duet-write_sbom"]},
        "packages": [product, *packages],
        "relationships": [
            {"spdxElementId": "SPDXRef-DOCUMENT", "relationshipType": "DESCRIBES",
             "relatedSpdxElement": "SPDXRef-Duet"},
            *({"spdxElementId": "SPDXRef-Duet", "relationshipType": "DEPENDS_ON",
               "relatedSpdxElement": package["SPDXID"]} for package in packages)],
    }


def main():
    parser = argparse.ArgumentParser(description=__doc__,
                                     formatter_class=argparse.RawDescriptionHelpFormatter)
    parser.add_argument("--version", required=True, help="of Duet")
    parser.add_argument("--created", required=True, help="YYYY-MM-DDThh:mm:ssZ")
    parser.add_argument("root", type=pathlib.Path)
    arguments = parser.parse_args()
    json.dump(document(arguments.root, arguments.version, arguments.created), sys.stdout, indent=1)
    print()


if __name__ == "__main__":
    main()
