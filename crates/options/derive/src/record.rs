//! Structs with named fields.

use crate::attributes::{FieldOptions, Range, Serde, doc, type_name};
use proc_macro2::{Group, Ident, TokenStream, TokenTree};
use quote::{ToTokens, quote};
use syn::{DeriveInput, Fields, GenericParam, Result, Type};

pub fn expand(input: &DeriveInput, fields: &Fields) -> Result<TokenStream> {
    let Fields::Named(fields) = fields else {
        return Err(syn::Error::new_spanned(input, "the fields of a record have names"));
    };
    let (ident, name, type_doc) = (&input.ident, type_name(input)?, doc(&input.attrs));
    if input.generics.params.iter().any(|param| !matches!(param, GenericParam::Lifetime(_))) {
        return Err(syn::Error::new_spanned(&input.generics, "a record has no parameters"));
    }
    let (generics, parameters, _) = input.generics.split_for_impl();
    let of_all = Serde::read(&input.attrs)?;
    let has_defaults = of_all.default;
    let (mut described, mut checks, mut defaults, mut has_default) =
        (vec![], vec![], vec![], false);
    for field in &fields.named {
        let options = FieldOptions::read(&field.attrs)?;
        let serde = Serde::read(&field.attrs)?;
        let (ident, ty) = (&field.ident, &field.ty);
        let default = options.default.as_ref().map_or_else(
            || quote!(::core::default::Default::default()),
            |expression| quote!(#expression),
        );
        has_default |= options.default.is_some();
        defaults.push(quote!(#ident: #default));
        if serde.skip {
            continue;
        }
        let own = ident.as_ref().map(ToString::to_string).unwrap_or_default();
        let wire = match serde.rename {
            Some(name) => name,
            None if of_all.camel_case => in_camel_case(&own),
            None => own,
        };
        let may_have_default = has_defaults || serde.default || is_option(ty);
        let (doc, may_be_absent) = (doc(&field.attrs), serde.may_be_absent);
        let range = range_tokens(options.range.as_ref());
        let described_as = as_static(options.described_as.as_ref().unwrap_or(ty).to_token_stream());
        let schema = options.schema.as_deref().unwrap_or("{}");
        let (kind, flat) = match &options.typescript {
            Some(text) => (
                quote! {
                    ::boresight_options::Kind::Special(
                        &::boresight_options::Special::in_typescript(#text, #schema),
                    )
                },
                quote!(false),
            ),
            None => (
                quote!(<#described_as as ::boresight_options::Described>::KIND),
                quote!(<#described_as as ::boresight_options::Described>::FLAT),
            ),
        };
        // A flat field is never given itself; its own fields may be required.
        let required = match (options.required, may_have_default) {
            (true, _) => quote!(true),
            (false, true) => quote!(false),
            (false, false) => quote!(!#flat),
        };
        let place = described.len();
        described.push(quote! {
            ::boresight_options::Field {
                name: #wire,
                doc: ::boresight_options::doc(#doc),
                kind: #kind,
                flat: #flat,
                range: #range,
                may_be_absent: #may_be_absent,
                required: #required,
            }
        });
        if options.described_as.is_some() || options.typescript.is_some() {
            continue;
        }
        checks.push(quote! {{
            let field = &FIELDS[#place];
            let own = at.field(field.name);
            let at = if field.flat { at } else { &own };
            ::boresight_options::Described::check(&self.#ident, field.range, at)?;
        }});
    }
    let default = has_default.then(|| {
        quote! {
            impl ::core::default::Default for #ident {
                fn default() -> Self {
                    Self { #(#defaults),* }
                }
            }
        }
    });
    Ok(quote! {
        const _: () = {
            const FIELDS: &[::boresight_options::Field] = &[#(#described),*];

            impl #generics ::boresight_options::Described for #ident #parameters {
                const KIND: ::boresight_options::Kind = ::boresight_options::Kind::Record(
                    &::boresight_options::Record {
                        name: #name,
                        doc: ::boresight_options::doc(#type_doc),
                        fields: FIELDS,
                    },
                );

                fn check(
                    &self,
                    _: ::core::option::Option<::boresight_options::Range>,
                    at: &::boresight_options::At<'_>,
                ) -> ::core::result::Result<(), ::boresight_options::InputError> {
                    #(#checks)*
                    ::core::result::Result::Ok(())
                }
            }

            #default
        };
    })
}

/// A type whose references live as long as the program, as a constant needs them.
fn as_static(tokens: TokenStream) -> TokenStream {
    let mut is_lifetime = false;
    let each = tokens.into_iter().map(|token| match token {
        TokenTree::Group(group) => Group::new(group.delimiter(), as_static(group.stream())).into(),
        TokenTree::Ident(ident) if std::mem::take(&mut is_lifetime) => {
            Ident::new("static", ident.span()).into()
        }
        other => {
            is_lifetime = matches!(&other, TokenTree::Punct(mark) if mark.as_char() == '\'');
            other
        }
    });
    each.collect()
}

/// As serde's `rename_all = "camelCase"` has it.
fn in_camel_case(name: &str) -> String {
    let mut parts = name.split('_');
    let first = parts.next().unwrap_or_default().to_owned();
    parts.fold(first, |name, part| {
        let (head, tail) = part.split_at(part.len().min(1));
        name + &head.to_uppercase() + tail
    })
}

fn is_option(ty: &Type) -> bool {
    matches!(ty, Type::Path(path) if path.path.segments.last().is_some_and(|s| s.ident == "Option"))
}

fn range_tokens(range: Option<&Range>) -> TokenStream {
    let some = |range| quote!(::core::option::Option::Some(::boresight_options::Range #range));
    match range {
        None => quote!(::core::option::Option::None),
        Some(Range::Positive) => some(quote!({ low: 0.0, high: f64::INFINITY, above_low: true })),
        Some(Range::Limits(low, Some(high))) => {
            some(quote!({ low: #low as f64, high: #high as f64, above_low: false }))
        }
        Some(Range::Limits(low, None)) => {
            some(quote!({ low: #low as f64, high: f64::INFINITY, above_low: false }))
        }
    }
}
