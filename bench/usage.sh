# Sourced by the scripts beside it with their words, and on stdin what --help prints: prints that, or names the folder
# of the repository.
case "${1:-}" in
  -h | --help)
    cat
    exit 0
    ;;
esac
root="$(cd "$(dirname "${BASH_SOURCE[0]}")/.." && pwd)"
