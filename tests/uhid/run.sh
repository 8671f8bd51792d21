#!/bin/sh
# The real SpaceMouse driver against a virtual device of the kernel's uhid, in a small virtual machine.
#   tests/uhid/run.sh [VMLINUZ MODULES]     a kernel and its modules' folder; by default those of this machine
# Needs qemu-system-x86_64, a static busybox and cpio (Debian: qemu-system-x86 busybox-static cpio), and a kernel with uhid.
# `cargo xtask test` brings what is missing when root, the kernel unpacked from its package where none is installed.
# Exit 0 passed, 1 failed, 77 skipped, which it says.
set -eu
cd "$(dirname "$0")/../.."
skip() { echo "SKIPPED: uhid test: $1"; exit 77; }
kernel=${1:-/boot/vmlinuz-$(uname -r)}
modules=${2:-/lib/modules/$(uname -r)}
[ "$(uname -m)" = x86_64 ] || skip "it is made for x86-64, this is $(uname -m)"
for tool in qemu-system-x86_64 cpio busybox; do
    command -v "$tool" >/dev/null || skip "$tool is not installed (Debian: apt install qemu-system-x86 busybox-static cpio)"
done
[ -r "$kernel" ] || skip "no kernel at $kernel"
work=$(mktemp -d)
trap 'rm -rf "$work"' EXIT
mkdir -p "$work/root/bin" "$work/root/proc" "$work/root/sys" "$work/root/dev" "$work/root/tmp"
cp "$(command -v busybox)" "$work/root/bin/busybox"
for module in hid hid-generic uhid; do
    file=$(find "$modules" -name "$module.ko*" | head -n 1)
    case "$file" in
        '') skip "no module $module under $modules" ;;
        *.xz) xz -dc "$file" >"$work/root/$module.ko" ;;
        *.zst) zstd -qdc "$file" >"$work/root/$module.ko" ;;
        *) cp "$file" "$work/root/$module.ko" ;;
    esac
done
# Static, so that the machine needs no C library.
RUSTFLAGS='-C target-feature=+crt-static' cargo build --quiet -p device --example virtual_spacemouse \
    --target x86_64-unknown-linux-gnu --target-dir target/uhid
cp target/uhid/x86_64-unknown-linux-gnu/debug/examples/virtual_spacemouse "$work/root/bin/"
cat >"$work/root/init" <<'INIT'
#!/bin/busybox sh
/bin/busybox mount -t proc proc /proc
/bin/busybox mount -t sysfs sys /sys
/bin/busybox mount -t devtmpfs dev /dev
for module in hid hid-generic uhid; do /bin/busybox insmod /$module.ko; done
/bin/virtual_spacemouse && echo "uhid: exit 0"
/bin/busybox poweroff -f
INIT
chmod +x "$work/root/init"
(cd "$work/root" && find . | cpio --quiet -o -H newc) | gzip >"$work/initrd.gz"
timeout 300 qemu-system-x86_64 -cpu qemu64 -m 256 -nographic -no-reboot -kernel "$kernel" -initrd "$work/initrd.gz" \
    -append 'console=ttyS0 quiet panic=-1' </dev/null >"$work/log" 2>&1 || true
grep -a -E '^(  |256f|046d|virtual|uhid|Error)' "$work/log" | tr -d '\r' || true
if ! grep -a -q 'uhid: exit 0' "$work/log"; then
    echo "error: uhid test failed; the machine's last words:"
    tail -n 20 "$work/log"
    exit 1
fi
