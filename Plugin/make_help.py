# SPDX-FileCopyrightText: The Quadrille maintainers
# SPDX-License-Identifier: BSD-3-Clause
"""The pages that the question mark in ParaView's panel opens, one for each filter, reader and writer:

  make_help.py FOLDER XML...

ParaView's own generator leaves our filters out: it knows the element SourceProxy, but not the one of a proxy of our
own, and not what a filter has from its base proxy. A page has the name that ParaView looks for, GROUP.NAME.html;
index.html is the page that the help window begins with.
"""
import html
import pathlib
import sys
import xml.etree.ElementTree as ElementTree

PROPERTIES = ("InputProperty", "IntVectorProperty", "DoubleVectorProperty", "StringVectorProperty",
              "IdTypeVectorProperty")


def text_of(element):
    """What is written in the Documentation of a proxy or property, on one line."""
    documentation = element.find("Documentation")
    return " ".join((documentation.text or "").split()) if documentation is not None else ""


def label_of(element):
    return element.get("label") or element.get("name")


def properties_of(proxy, proxies):
    """By name, those of the base proxy first; what the proxy says itself goes before."""
    base = proxies.get((proxy.get("base_proxygroup"), proxy.get("base_proxyname")))
    found = properties_of(base, proxies) if base is not None else {}
    found.update({p.get("name"): p for p in proxy if p.tag in PROPERTIES})
    return found


def groups_of(proxy, properties):
    """Pairs of a title and its properties, as the panel orders them; inputs, and what no group has, come first."""
    groups = [(group.get("label"), [properties[p.get("name")] for p in group.findall("Property")
                                    if p.get("name") in properties])
              for group in proxy.findall("PropertyGroup")]
    grouped = {p.get("name") for _, members in groups for p in members}
    return [("", [p for name, p in properties.items() if name not in grouped])] + groups


def value_of(prop):
    """The default in the words of the panel; nothing for an input and for what the filter tells."""
    value = prop.get("default_values") or ""
    if prop.get("information_only") == "1" or prop.tag == "InputProperty":
        return ""
    for entry in prop.findall("EnumerationDomain/Entry"):
        if entry.get("value") == value:
            return entry.get("text")
    if prop.find("BooleanDomain") is not None:
        return "on" if value == "1" else "off"
    return value


def choices_of(prop):
    entries = [entry.get("text") for entry in prop.findall("EnumerationDomain/Entry")]
    return f" One of: {', '.join(entries)}." if entries else ""


def table_of(title, members):
    rows = [f"<tr><td><b>{html.escape(label_of(p))}</b></td><td>{html.escape(text_of(p) + choices_of(p))}</td>"
            f"<td>{html.escape(value_of(p))}</td></tr>" for p in members if p.get("panel_visibility") != "never"]
    if not rows:
        return ""
    heading = f"<h3>{html.escape(title)}</h3>\n" if title else ""
    return (heading + "<table width=\"97%\" border=\"1\" cellspacing=\"0\" cellpadding=\"4\">\n"
            "<tr><th width=\"22%\">Property</th><th>What it does</th><th width=\"14%\">At first</th></tr>\n"
            + "\n".join(rows) + "\n</table>\n")


def page_of(proxy, proxies):
    title = html.escape(label_of(proxy))
    outputs = "".join(f"<li>{html.escape(port.get('name'))}</li>" for port in proxy.findall("OutputPort"))
    tables = "".join(table_of(*group) for group in groups_of(proxy, properties_of(proxy, proxies)))
    return (f"<html><head><title>{title}</title></head><body>\n<h2>{title}</h2>\n<p>{html.escape(text_of(proxy))}</p>\n"
            + (f"<p>Outputs:</p><ol>{outputs}</ol>\n" if outputs else "") + tables + "</body></html>\n")


def index_of(pages):
    """The page that the help window shows at first: all others, by their titles."""
    links = "".join(f'<li><a href="{html.escape(name)}">{html.escape(title)}</a></li>\n'
                    for title, name in sorted(pages))
    return f"<html><head><title>Quadrille</title></head><body>\n<h2>Quadrille</h2>\n<ul>\n{links}</ul></body></html>\n"


def main(folder, *files):
    groups = [group for file in files for group in ElementTree.parse(file).getroot().findall("ProxyGroup")]
    proxies = {(group.get("name"), proxy.get("name")): proxy for group in groups for proxy in group
               if proxy.get("class")}
    pathlib.Path(folder).mkdir(parents=True, exist_ok=True)
    pages = []
    for (group, name), proxy in proxies.items():
        if group in ("filters", "sources", "writers"):
            page = f"{group}.{name}.html"
            pathlib.Path(folder, page).write_text(page_of(proxy, proxies), encoding="utf-8")
            pages.append((label_of(proxy), page))
    pathlib.Path(folder, "index.html").write_text(index_of(pages), encoding="utf-8")


if __name__ == "__main__":
    main(*sys.argv[1:])
