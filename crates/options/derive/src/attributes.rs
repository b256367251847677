//! What the attributes of a field, a variant or a type say.

use syn::{
    Attribute, DeriveInput, Expr, ExprLit, ExprRange, Lit, LitStr, Meta, RangeLimits, Result, Type,
};

/// The doc comment as one paragraph of text.
pub fn doc(attributes: &[Attribute]) -> String {
    let lines = attributes.iter().filter_map(|attribute| match &attribute.meta {
        Meta::NameValue(pair) if pair.path.is_ident("doc") => match &pair.value {
            Expr::Lit(ExprLit { lit: Lit::Str(text), .. }) => Some(text.value().trim().to_owned()),
            _ => None,
        },
        _ => None,
    });
    lines.collect::<Vec<_>>().join(" ").trim().to_owned()
}

/// What `#[option(...)]` says of a field.
#[derive(Default)]
pub struct FieldOptions {
    pub default: Option<Expr>,
    pub range: Option<Range>,
    pub described_as: Option<Type>,
    pub typescript: Option<String>,
    /// The JSON Schema of a field with a type in TypeScript.
    pub schema: Option<String>,
    pub required: bool,
}

/// The numbers a field may have.
pub enum Range {
    Limits(Box<Expr>, Option<Box<Expr>>),
    Positive,
}

impl FieldOptions {
    pub fn read(attributes: &[Attribute]) -> Result<Self> {
        let mut options = Self::default();
        for attribute in attributes.iter().filter(|a| a.path().is_ident("option")) {
            attribute.parse_nested_meta(|meta| {
                if meta.path.is_ident("default") {
                    options.default = Some(meta.value()?.parse()?);
                } else if meta.path.is_ident("range") {
                    options.range = Some(limits(meta.value()?.parse()?)?);
                } else if meta.path.is_ident("positive") {
                    options.range = Some(Range::Positive);
                } else if meta.path.is_ident("described_as") {
                    options.described_as = Some(meta.value()?.parse()?);
                } else if meta.path.is_ident("typescript") {
                    options.typescript = Some(meta.value()?.parse::<LitStr>()?.value());
                } else if meta.path.is_ident("schema") {
                    options.schema = Some(meta.value()?.parse::<LitStr>()?.value());
                } else if meta.path.is_ident("required") {
                    options.required = true;
                } else {
                    return Err(meta.error(
                        "expected default, range, positive, required, described_as, typescript or schema",
                    ));
                }
                Ok(())
            })?;
        }
        Ok(options)
    }
}

fn limits(range: ExprRange) -> Result<Range> {
    let wrong = || syn::Error::new_spanned(&range, "expected LOW..=HIGH or LOW..");
    let low = range.start.clone().ok_or_else(wrong)?;
    match (&range.limits, range.end.clone()) {
        (RangeLimits::Closed(_), Some(high)) => Ok(Range::Limits(low, Some(high))),
        (RangeLimits::HalfOpen(_), None) => Ok(Range::Limits(low, None)),
        _ => Err(wrong()),
    }
}

/// The name that `#[option(name = "...")]` gives a type outside Rust, or its own.
pub fn type_name(input: &DeriveInput) -> Result<String> {
    let mut name = input.ident.to_string();
    for attribute in input.attrs.iter().filter(|a| a.path().is_ident("option")) {
        attribute.parse_nested_meta(|meta| {
            if !meta.path.is_ident("name") {
                return Err(meta.error("expected name"));
            }
            name = meta.value()?.parse::<LitStr>()?.value();
            Ok(())
        })?;
    }
    Ok(name)
}

/// What `#[serde(...)]` says of a field or a type.
#[derive(Default)]
pub struct Serde {
    pub skip: bool,
    pub may_be_absent: bool,
    pub rename: Option<String>,
    /// Whether what is absent is taken from a default.
    pub default: bool,
    /// Whether the fields are written as JavaScript writes them.
    pub camel_case: bool,
}

impl Serde {
    pub fn read(attributes: &[Attribute]) -> Result<Self> {
        let mut serde = Self::default();
        for attribute in attributes.iter().filter(|a| a.path().is_ident("serde")) {
            attribute.parse_nested_meta(|meta| {
                if meta.path.is_ident("skip") {
                    serde.skip = true;
                } else if meta.path.is_ident("skip_serializing_if") {
                    serde.may_be_absent = true;
                    let _: LitStr = meta.value()?.parse()?;
                } else if meta.path.is_ident("default") {
                    serde.default = true;
                    if meta.input.peek(syn::Token![=]) {
                        let _: Expr = meta.value()?.parse()?;
                    }
                } else if meta.path.is_ident("rename_all") {
                    serde.camel_case = meta.value()?.parse::<LitStr>()?.value() == "camelCase";
                } else if meta.path.is_ident("rename") {
                    serde.rename = Some(meta.value()?.parse::<LitStr>()?.value());
                } else if meta.input.peek(syn::Token![=]) {
                    let _: Expr = meta.value()?.parse()?;
                }
                Ok(())
            })?;
        }
        Ok(serde)
    }
}
