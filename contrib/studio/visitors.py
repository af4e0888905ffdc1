"""Who sends a request: the address of its connection, or the one that a trusted proxy names."""

import ipaddress

IPV6_PREFIX = 64  # bits; one visitor has all addresses that share them


def networks_of(proxies):
    """The networks of --proxy, each an address or a network. Raises ValueError with the wrong one."""
    networks = []
    for text in proxies:
        try:
            networks.append(ipaddress.ip_network(text, strict=False))
        except ValueError:
            raise ValueError(f"--proxy: expected an address or a network such as 10.0.0.0/8, got "
                             f"{text!r}") from None
    return networks


def visitor_of(request, proxies):
    """The visitor that a request counts for. `proxies` are networks whose X-Forwarded-For is trusted;
    each proxy appends the address that it was called from."""
    forwarded = [part.strip() for line in request.headers.getall("X-Forwarded-For", ())
                 for part in line.split(",")]
    address = request.remote or ""
    while forwarded and is_within(address, proxies):
        address = forwarded.pop()
    found = parsed(address)
    if found is None:
        return address
    if found.version == 6:
        return str(ipaddress.ip_network((found, IPV6_PREFIX), strict=False))
    return str(found)


def is_within(address, networks):
    found = parsed(address)
    return found is not None and any(found in network for network in networks)


def parsed(address):
    """An address as text; None if it is none."""
    try:
        found = ipaddress.ip_address(address.strip("[]"))
    except ValueError:
        return None
    return getattr(found, "ipv4_mapped", None) or found
