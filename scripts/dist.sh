#!/bin/sh
# Make the tarball of a release from the last commit: dist.sh FOLDER. The same commit gives the same
# bytes: git archive sorts files and dates them all by the commit; xz works in one thread.
set -eu
out=$1
cd "$(dirname "$0")/.."
if ! commit=$(git rev-parse --verify -q HEAD 2>/dev/null); then
    echo "dist: no commit to make it of; expected a git checkout (an unpacked tarball is one already)" >&2
    exit 1
fi
[ -z "$(git status --porcelain --untracked-files=no)" ] ||
    echo "dist: warning: what is not committed is left out" >&2
version=$(git show HEAD:include/relume/base.h | sed -n 's/^#define RELUME_VERSION "\(.*\)"/\1/p')
name=relume-$version
date=$(TZ=UTC git log -1 --format=%cd --date=format-local:%Y-%m-%dT%H:%M:%SZ)
mkdir -p "$out"
work=$(mktemp -d)
trap 'rm -rf "$work"' EXIT
git archive --format=tar --prefix="$name/" HEAD >"$work/$name.tar"
tar -xf "$work/$name.tar" -C "$work"

# What is in it, by SPDX 2.3 (tag-value). The package verification code is the SHA-1 of all files'
# SHA-1 sums in order (clause 7.9).
(cd "$work/$name" && find . -type f | LC_ALL=C sort >../files)
(cd "$work/$name" && xargs -d '\n' sha1sum <../files >../sums1 && xargs -d '\n' sha256sum <../files >../sums256)
code=$(cut -c1-40 "$work/sums1" | LC_ALL=C sort | tr -d '\n' | sha1sum | cut -c1-40)
{
    cat <<SPDX
SPDXVersion: SPDX-2.3
DataLicense: CC0-1.0
SPDXID: SPDXRef-DOCUMENT
DocumentName: $name
DocumentNamespace: urn:relume:spdx:$version:$commit
Creator: Tool: relume scripts/dist.sh
Created: $date

PackageName: relume
SPDXID: SPDXRef-Package
PackageVersion: $version
PackageFileName: $name.tar.xz
PackageDownloadLocation: NOASSERTION
FilesAnalyzed: true
PackageVerificationCode: $code
PackageLicenseConcluded: MIT
PackageLicenseInfoFromFiles: MIT
PackageLicenseDeclared: MIT
PackageCopyrightText: <text>Copyright (c) 2026 the relume authors</text>
Relationship: SPDXRef-DOCUMENT DESCRIBES SPDXRef-Package
SPDX
    awk 'NR == FNR { sha256[substr($0, 67)] = substr($0, 1, 64); next }
        {
            file = substr($0, 43)
            printf "\nFileName: %s\nSPDXID: SPDXRef-File-%d\n", file, FNR
            printf "FileChecksum: SHA1: %s\nFileChecksum: SHA256: %s\n", substr($0, 1, 40), sha256[file]
            print "LicenseConcluded: MIT\nLicenseInfoInFile: NOASSERTION\nFileCopyrightText: NOASSERTION"
        }' "$work/sums256" "$work/sums1"
} >"$out/$name.spdx"
rm -rf "${work:?}/$name"
xz -6 -T1 -c "$work/$name.tar" >"$out/$name.tar.xz"
(cd "$out" && sha256sum "$name.tar.xz" "$name.spdx" >SHA256SUMS)
echo "  $out/$name.tar.xz"
